"""Raw values of cameras to XYZ on held-out patches, by cubes and by matrices, for
docs/guides/cameras.md.
"""

from collections import defaultdict
from collections.abc import Callable
from itertools import product, starmap

import numpy as np
from scipy.optimize import least_squares

from benchmarks import Row, record
from benchmarks.choices import ALONE, OURS, mark
from uplift.atlas import Atlas, on_grid, read_atlas
from uplift.colorimetry import Sensor, delta_e_2000, lab, observer, solid, tables
from uplift.colorimetry.camera import CAMERA
from uplift.common.arrays import Array, Indices
from uplift.fit import shipped_library
from uplift.lab.study.held_out import random_halves
from uplift.lab.study.look_alikes import families_like
from uplift.lattice import Lattice, axis_nodes
from uplift.lookup import Cube
from uplift.pipeline.build import build

ATLAS = "macbeth"
LIGHTS = ("D65", "A")
SPLITS = 5
DIM = 32
CHOSEN_AS = {"cube without an atlas": ALONE, "cube": OURS, "cube, refined": OURS}
"""Methods that depend on choices of the design, by their names there."""
ToXyz = Callable[[Array], Array]
"""From raw values (n, 3) to XYZ (n, 3)."""


def xyz_matrix(raw: Array, xyz: Array) -> Array:
    """Fit the matrix (3, 3) from raw values to XYZ by least squares of XYZ."""
    return np.linalg.lstsq(raw, xyz, rcond=None)[0].T


def lab_matrix(raw: Array, xyz: Array, white: Array) -> Array:
    """Fit the matrix (3, 3) from raw values to XYZ by least squares of L*a*b*, with (1,
    1, 1) as ``white``.

    RAW to ACES 1.0 (Dyer et al. 2017) fits its matrices so, with six free numbers.
    """
    expected = lab(xyz, white)

    def matrix(free: Array) -> Array:
        first = free.reshape(3, 2)
        return np.column_stack([first, white - first.sum(axis=1)])

    def residuals(free: Array) -> Array:
        return (lab(raw @ matrix(free).T, white) - expected).ravel()

    start = xyz_matrix(raw, xyz)
    return matrix(least_squares(residuals, start[:, :2].ravel()).x)


def methods(
    atlas: Atlas, training: Indices, sensor: Sensor, plain: Cube
) -> dict[str, ToXyz]:
    """Return the methods, each trained on the rows ``training`` of an atlas, ``plain``
    on none.
    """
    measured = on_grid(atlas, sensor.wavelengths)
    library = np.concatenate(
        [family.measured for family in shipped_library(families_like(measured))]
    )
    half = measured[training]
    entries = Atlas(tuple(atlas.entries[row] for row in training))
    cube = _build(entries, sensor, measured)
    white = sensor.light.white

    def by_matrix(spectra: Array, *white: Array) -> ToXyz:
        fit = lab_matrix if white else xyz_matrix
        matrix = fit(sensor.rgb(spectra), spectra @ sensor.light.xyz.T, *white)
        return lambda raw: raw @ matrix.T

    def by_cube(cube: Cube, mode: str = "spectra") -> ToXyz:
        return lambda raw: (
            cube.reflectance(raw, sensor.wavelengths, mode) @ sensor.light.xyz.T
        )

    return {
        "matrix, XYZ": by_matrix(half),
        "matrix, L*a*b*": by_matrix(half, white),
        "matrix, L*a*b*, with the library": by_matrix(
            np.concatenate([half, library]), white
        ),
        "cube without an atlas": by_cube(plain),
        "cube": by_cube(cube),
        "cube, refined": by_cube(cube, "refined"),
    }


def _build(entries: Atlas | None, sensor: Sensor, measured: Array) -> Cube:
    """Build a cube whose prior does not know the families of measured reflectances (E,
    N).
    """
    return build(
        entries,
        dim=DIM,
        space=CAMERA,
        observer=sensor.space,
        illuminant=sensor.illuminant,
        leave_out=families_like(measured),
    )


def realisable_share(sensor: Sensor, dim: int = DIM) -> float:
    """Return the share of the nodes of a lattice of raw values that are realisable."""
    nodes = Lattice(axis_nodes("srgb", dim)).points
    return solid(sensor.matrix).contains(nodes).mean()


def compare(camera: str, illuminant: str) -> Row:
    """Compare the methods on the held-out halves of all splits."""
    atlas = read_atlas(ATLAS)
    sensor = observer.sensor(CAMERA, illuminant, camera)
    measured = on_grid(atlas, sensor.wavelengths)
    white = sensor.light.white
    raw = sensor.rgb(measured)
    expected = lab(measured @ sensor.light.xyz.T, white)
    plain = _build(None, sensor, measured)
    errors = defaultdict(list)
    for seed in range(SPLITS):
        training, held_out = random_halves(len(measured), seed)
        for name, to_xyz in methods(atlas, training, sensor, plain).items():
            answers = lab(to_xyz(raw[held_out]), white)
            delta_e = delta_e_2000(answers, expected[held_out])
            errors[name].append(delta_e)
    figures = {}
    for name, splits in errors.items():
        pooled = np.concatenate(splits)
        figures[name] = {"mean": pooled.mean(), "high": np.percentile(pooled, 95)}
    return {
        "camera": camera,
        "light": illuminant,
        "realisable": 100 * realisable_share(sensor),
        "errors": figures,
    }


def main() -> None:
    """Measure, and write the data of the page."""
    rows = list(starmap(compare, product(tables.names("camera"), LIGHTS)))
    record(
        "cameras",
        atlas=ATLAS,
        splits=SPLITS,
        dim=DIM,
        marks={
            method: mark([ATLAS], CHOSEN_AS[method]) if method in CHOSEN_AS else ""
            for method in rows[0]["errors"]
        },
        rows=rows,
    )
