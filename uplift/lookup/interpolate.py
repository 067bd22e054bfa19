"""Multipliers and spectra between lattice points, in three modes (DESIGN 3.8). numpy alone.

spectra   the eight corners' spectra, weighted: exact, as RGB is linear in the spectrum
moments   the eight corners' coefficients, weighted: one reconstruction in place of eight
refined   ``moments``, then steps of least change to the very colour
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.cube import CubeData
from uplift.lattice import Indices
from uplift.models.least_change import Forward, forward, residual, step
from uplift.sensor import Array

REFINED = 1e-8
"""Residual, max |linear RGB|, at which ``refined`` stops."""
MOST_STEPS = 4
BLOCK = 8192
"""Colours worked on at a time, so that memory does not grow with the number asked."""


def coefficients(data: CubeData, rgb: Array) -> Array:
    """Coefficients (n, C) at linear RGB (n, 3) in [0, 1]: the eight corners' own, weighted."""
    points, weights = data.lattice.corners(rgb)
    return (weights[:, None, :] @ data.coefficients[points])[:, 0, :]


def spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as the weighted spectra of the cell's corners."""
    points, weights = data.lattice.corners(rgb)
    used, place = np.unique(points, return_inverse=True)
    corners = _evaluate(data, data.model.from_storage(data.coefficients[used]), wavelengths)
    place = place.reshape(points.shape)
    total = np.zeros((len(rgb), len(wavelengths)))
    for corner in range(points.shape[1]):
        total += weights[:, corner, None] * corners[place[:, corner]]
    return total


def moments(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the interpolated coefficients."""
    return _evaluate(data, data.model.from_storage(coefficients(data, rgb)), wavelengths)


def refined(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the interpolated coefficients, moved to the colour asked for."""
    return _evaluate(data, refined_multipliers(data, rgb), wavelengths)


def refined_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) that start at the interpolated coefficients and evaluate to ``rgb`` (n, 3)."""
    multipliers = data.model.from_storage(coefficients(data, rgb))
    ahead = forward(data.model, data.sensor.wavelengths, data.sensor.matrix)
    off = residual(data.model, ahead, multipliers, rgb)
    for _ in range(MOST_STEPS):
        rows = np.flatnonzero(np.abs(off).max(axis=1) > REFINED)
        if not rows.size:
            break
        _refine(data, ahead, multipliers, off, rgb, rows)
    return multipliers


def _refine(
    data: CubeData, ahead: Forward, multipliers: Array, off: Array, rgb: Array, rows: Indices
) -> None:
    """One step for ``rows``, in place, where it helps."""
    here = multipliers[rows]
    there = here + step(data.model, ahead, here, off[rows], np.zeros(len(rows)))
    off_there = residual(data.model, ahead, there, rgb[rows])
    better = (off_there**2).sum(axis=1) < (off[rows] ** 2).sum(axis=1)
    multipliers[rows[better]] = there[better]
    off[rows[better]] = off_there[better]


def _evaluate(data: CubeData, multipliers: Array, wavelengths: Array) -> Array:
    return np.asarray(data.model.squash(multipliers @ data.model.basis(wavelengths).T))


Mode = Callable[[CubeData, Array, Array], Array]

MODES: dict[str, Mode] = {"spectra": spectra, "moments": moments, "refined": refined}
