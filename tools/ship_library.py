"""Write the library that shapes the prior: ``python -m tools.ship_library [FILE]``
(docs/prior.md).

It consists of the shipped atlases, and of spectra by Otsu et al. 2018, which stand for
the Munsell book that their clusters were learnt from. With it are the tables of smooth
spectra of usual RGB spaces, which builds need not solve again.
tests/fit/test_families.py compares the shipped file with the output.
"""

import sys
import warnings
from pathlib import Path
from typing import Any

import colour
import numpy as np
from colour.recovery import otsu2018

from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.fit.base import TABLE, smooth
from uplift.fit.families import STEPS
from uplift.fit.problem import Problem, nodes_of
from uplift.models.moments import Moments

ROOT = Path(__file__).parents[1]
FILE = ROOT / "uplift" / "fit" / "library.npz"
FAMILIES = {"checker": ("macbeth", "babelcolor")} | {
    name: (name,) for name in ("pmc", "tcs", "vs", "cie2017", "rawtoaces")
}
"""Shipped atlases by family: the two ColorCheckers are one chart."""
SPREAD, OTSU_SPREAD = 5.0, 3.0
"""Variance of what is peculiar to a family, chosen in docs/prior.md; the Munsell book
is larger than the others.
"""
SPACES = ("sRGB", "ACEScg", "ITU-R BT.2020")
"""RGB spaces whose tables are stored."""
SPACE = "ITU-R BT.2020"
CANDIDATES, SPECTRA = 30_000, 320
"""Random colours, and those of them that are taken: in turn the one farthest from all
before.
"""
BLUR = 0.01
"""Width, in CIE xy, of the transition between clusters: their seams must not show."""


def main(path: Path = FILE) -> None:
    """Write the library."""
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):
        families = {name: measurements(atlases) for name, atlases in FAMILIES.items()}
    families["otsu2018"] = otsu_spectra()
    sensors = [observer.sensor(space) for space in SPACES]
    tables = [smooth_nodes(Problem(sensor, Moments())) for sensor in sensors]
    steps = np.rint(np.concatenate(list(families.values())) * STEPS).astype(np.int16)
    smooth: dict[str, Any] = {
        f"smooth{number}": table for number, table in enumerate(tables)
    }
    np.savez_compressed(
        path,
        names=np.array(list(families)),
        counts=np.array([len(measured) for measured in families.values()]),
        spreads=np.array([SPREAD] * len(FAMILIES) + [OTSU_SPREAD]),
        steps=np.diff(steps, axis=1, prepend=np.int16(0)),
        matrices=np.stack([sensor.matrix for sensor in sensors]),
        **smooth,
    )


def smooth_nodes(problem: Problem) -> Array:
    """Coefficients (17³, 9) of smooth spectra at the nodes of the table."""
    nodes = nodes_of(TABLE, problem.sensor)
    return np.asarray(
        smooth(problem.model, problem.forward, nodes.goal(nodes.points)).nodes
    )


def measurements(atlases: tuple[str, ...]) -> Array:
    """Reflectances (E, 81) of shipped atlases."""
    paths = [ROOT / "atlases" / f"{name}.txt" for name in atlases]
    return resample(read_atlas(*paths), observer.grid()).values


def otsu_spectra() -> Array:
    """Spectra (320, 81) by Otsu et al. of colours evenly spread over those that need no
    clipping.
    """
    sensor = observer.sensor(SPACE)
    rgb = np.random.default_rng(2018).random((CANDIDATES, 3)) ** 2
    spectra = blurred_otsu(sensor.xyz(rgb), sensor.light.xyz)
    valid = (spectra.min(axis=1) >= 0) & (spectra.max(axis=1) <= 1)
    return np.asarray(spectra[valid][farthest(rgb_to_lab(sensor, rgb[valid]), SPECTRA)])


def blurred_otsu(xyz: Array, light: Array) -> Array:
    """Spectra (n, 81) of XYZ (n, 3) under a light (3, 81), blended between clusters;
    exact, not clipped.
    """
    shape = otsu2018.SPECTRAL_SHAPE_OTSU2018
    resampled = np.stack(
        [np.interp(observer.grid(), shape.wavelengths, row) for row in np.eye(36)]
    )
    basis, means = (
        table @ resampled
        for table in (
            otsu2018.BASIS_FUNCTIONS_OTSU2018,
            otsu2018.CLUSTER_MEANS_OTSU2018,
        )
    )
    xy = colour.XYZ_to_xy(xyz)
    spectra = np.zeros((len(xyz), basis.shape[-1]))
    for cluster, share in enumerate(shares(xy, len(basis)).T):
        scores = np.linalg.solve(
            light @ basis[cluster].T, (xyz - light @ means[cluster]).T
        )
        spectra += share[:, None] * (means[cluster] + scores.T @ basis[cluster])
    return spectra


def shares(xy: Array, clusters: int) -> Array:
    """Share of each cluster (n, 8) at chromaticities (n, 2), by the decision tree with
    blurred thresholds.
    """
    tree = otsu2018.SELECTOR_ARRAY_OTSU2018
    found = np.zeros((len(xy), clusters))

    def descend(node: int, share: Array) -> None:
        threshold, axis, *branches = tree[node]
        above = 1 / (1 + np.exp((threshold - xy[:, int(axis)]) / BLUR))
        for branch, part in zip(
            map(int, branches), (share * (1 - above), share * above), strict=True
        ):
            if branch < 0:
                descend(-branch, part)
            else:
                found[:, branch] += part

    descend(0, np.ones(len(xy)))
    return found


def farthest(points: Array, count: int) -> list[int]:
    """Rows of points, each the farthest from all before."""
    rows = [0]
    distance = np.linalg.norm(points - points[0], axis=1)
    while len(rows) < count:
        rows.append(int(distance.argmax()))
        distance = np.minimum(
            distance, np.linalg.norm(points - points[rows[-1]], axis=1)
        )
    return rows


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
