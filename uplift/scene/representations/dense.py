"""The densely sampled data that every representation is made from and held against: 380–780 nm at 1 nm."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.common.arrays import Array

STEP = 1.0
TABLE_STRIDE = round(observer.STEP / STEP)
"""Every so many samples of the dense data lies one of the tables that lights are published as, 81 in all."""


def wavelengths() -> Array:
    """(401,) nm."""
    return np.arange(observer.START, observer.END + STEP / 2, STEP)


@functools.cache
def xyz_weights() -> Array:
    """(401, 3) weights: ``spectra @ observed()`` is XYZ, where a power of 1 at every wavelength has Y = 1."""
    cmfs = observer.matching_functions(step=STEP)
    weights = cmfs / cmfs[:, 1].sum()
    weights.setflags(write=False)
    return weights


def hat_functions(points: ArrayLike) -> Array:
    """(n, 401) what linear interpolation between ascending ``points`` (n,) nm gives each of them a share of."""
    points = np.asarray(points, dtype=float)
    return np.stack([np.interp(wavelengths(), points, row) for row in np.eye(len(points))])


def interp_spectra(spectra: Array, points: ArrayLike) -> Array:
    """Dense ``spectra`` (n, 401) at ``points`` (K,) or (n, K) nm within them, linear between samples."""
    places = (np.asarray(points, dtype=float) - observer.START) / STEP
    left = np.clip(places.astype(np.intp), 0, spectra.shape[1] - 2)
    if places.ndim == 1:
        before, after = spectra[:, left], spectra[:, left + 1]
    else:
        before, after = (np.take_along_axis(spectra, index, axis=1) for index in (left, left + 1))
    return np.asarray(before + (places - left) * (after - before))
