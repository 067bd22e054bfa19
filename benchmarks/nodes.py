"""How few wavelengths would do for the fit: rules of fewer nodes, against all 81."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr
from scipy.optimize import nnls

from benchmarks.timing import ROOT
from uplift.common.arrays import Array
from uplift.lookup import load
from uplift.models import reflectance

COUNTS = (16, 24, 32, 48)
SPECTRA = 3000


@dataclass(frozen=True)
class NodesError:
    """|linear RGB| by which ``count`` wavelengths miss what all give: median and largest, of spectra not learnt from.

    ``any_sign`` with weights of any sign, ``positive`` with weights on XYZ that are not negative.
    """

    count: int
    any_sign: tuple[float, float]
    positive: tuple[float, float]


def nodes_errors() -> list[NodesError]:
    """Nodes by pivoted QR of half of a cube's spectra, weights by least squares over the same."""
    data = load(ROOT / "cubes" / "moments-16.uplift").data
    sensor = data.sensor
    chosen = np.random.default_rng(0).permutation(data.lattice.size)[:SPECTRA]
    learn, judge = np.array_split(
        reflectance(data.model, data.points.coefficients[chosen], sensor.wavelengths), 2
    )
    importance = np.sqrt(sensor.light.xyz.sum(axis=0))
    _, _, order = qr(learn * importance, mode="economic", pivoting=True)
    found = []
    for count in COUNTS:
        nodes = np.sort(order[:count])
        free = np.linalg.lstsq(learn[:, nodes], learn @ sensor.matrix.T, rcond=None)[0]
        xyz = np.stack([nnls(learn[:, nodes], learn @ row)[0] for row in sensor.light.xyz], axis=1)
        found.append(
            NodesError(
                count, *(_missed(judge, sensor.matrix, nodes, w) for w in (free, xyz @ sensor.xyz_to_rgb.T))
            )
        )
    return found


def _missed(spectra: Array, matrix: Array, nodes: Array, weights: Array) -> tuple[float, float]:
    missed = np.abs(spectra[:, nodes.astype(int)] @ weights - spectra @ matrix.T).max(axis=1)
    return float(np.median(missed)), float(missed.max())
