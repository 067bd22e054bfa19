"""Densely sampled spectra that representations encode and are compared with: 380–780 nm at 1 nm."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.common.arrays import Array

STEP = 1.0
"""Distance of dense samples in nm."""
TABLE_STRIDE = round(observer.STEP / STEP)
"""Dense samples per sample of the 5 nm tables, of 81 samples, in which lights are published."""


def wavelengths() -> Array:
    """Wavelengths (401,) in nm."""
    return np.arange(observer.START, observer.END + STEP / 2, STEP)


@functools.cache
def xyz_weights() -> Array:
    """Weights (401, 3): ``spectra @ xyz_weights()`` is XYZ, where a power of 1 at every wavelength has Y = 1."""
    cmfs = observer.matching_functions(step=STEP)
    weights = cmfs / cmfs[:, 1].sum()
    weights.setflags(write=False)
    return weights


def hat_functions(points: ArrayLike) -> Array:
    """Basis (n, 401) of linear interpolation between ascending ``points`` (n,) nm."""
    points = np.asarray(points, dtype=float)
    return np.stack([np.interp(wavelengths(), points, row) for row in np.eye(len(points))])


def interpolation_matrix(points: Array) -> Array:
    """Matrix (401, n) that maps dense spectra to their values at ``points`` (n,) nm, linear between samples."""
    return np.asarray(np.maximum(1 - np.abs(wavelengths()[:, None] - points), 0))


def interp_rows(spectra: Array, points: Array) -> Array:
    """Values (n, K) of dense spectra (n, 401), each at its own ``points`` (n, K) nm, linear between samples."""
    position = (points - observer.START) / STEP
    left = np.clip(position.astype(np.intp), 0, spectra.shape[1] - 2)
    before, after = (np.take_along_axis(spectra, index, axis=1) for index in (left, left + 1))
    return np.asarray(before + (position - left) * (after - before))
