"""Quadrature rules of few wavelengths for the fit, compared with all 81."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import qr
from scipy.optimize import nnls

from benchmarks.record import ROOT
from uplift.common.arrays import Array
from uplift.lookup import load
from uplift.models import reflectance

COUNTS = (16, 24, 32, 48)
SPECTRA = 3000


def quadrature_errors() -> list[dict[str, Any]]:
    """Return the error of rules of few wavelengths, |linear RGB|, as [median, largest] over held-out spectra.

    ``any_sign`` allows weights of any sign, ``positive`` only non-negative weights on XYZ. Nodes come from a pivoted QR
    decomposition of half of a cube's spectra, weights from least squares over the same half.
    """
    data = load(ROOT / "cubes" / "moments-16.uplift").data
    sensor = data.sensor
    chosen = np.random.default_rng(0).permutation(data.lattice.size)[:SPECTRA]
    learn, held_out = np.array_split(reflectance(data.model, data.points.coefficients[chosen], sensor.wavelengths), 2)
    importance = np.sqrt(sensor.light.xyz.sum(axis=0))
    _, _, order = qr(learn * importance, mode="economic", pivoting=True)
    rows = []
    for count in COUNTS:
        nodes = np.sort(order[:count])
        free = np.linalg.lstsq(learn[:, nodes], learn @ sensor.matrix.T, rcond=None)[0]
        xyz = np.stack([nnls(learn[:, nodes], learn @ row)[0] for row in sensor.light.xyz], axis=1)
        weights = {"any_sign": free, "positive": xyz @ sensor.xyz_to_rgb.T}
        errors = {kind: _errors(held_out, sensor.matrix, nodes, one) for kind, one in weights.items()}
        rows.append({"wavelengths": count, **errors})
    return rows


def _errors(spectra: Array, matrix: Array, nodes: Array, weights: Array) -> list[float]:
    errors = np.abs(spectra[:, nodes.astype(int)] @ weights - spectra @ matrix.T).max(axis=1)
    return [float(np.median(errors)), float(errors.max())]
