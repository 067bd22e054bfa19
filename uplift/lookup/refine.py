"""Move multipliers to exact colours by minimum-norm steps (`uplift.models.minimum_norm`). Needs numpy only.

Spectra are columns here, so that all arithmetic runs along contiguous memory. A spectrum is evaluated once; later steps
add its changes, which need no arc tangents of large numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uplift.colorimetry.solid import solid, toward_grey
from uplift.common.arrays import Array, Indices
from uplift.cube import CubeData
from uplift.models import Model
from uplift.models.matmul import matmul_columns
from uplift.models.minimum_norm import ForwardMap, forward_map, solve_3x3
from uplift.models.roots import MAX_MULTIPLIER

TOLERANCE = 1e-8
"""Residual, max |linear RGB|, at which a colour is exact."""
MAX_STEPS = 24
FIRST_DAMPING = 1e-2
"""μ after a rejected full step; nearly all colours need one or two full steps and no damping."""
BLOCK_COLUMNS = 1024
"""Spectra processed at a time: their temporary arrays fit into the cache."""


def refine_to_rgb(data: CubeData, model: Model, start: Array, rgb: Array) -> Array:
    """Move multipliers ``start`` (n, C) of a model to linear RGB (n, 3), to the sensor and threshold of a cube.

    Unrealisable colours are replaced by the nearest realisable ones of less chroma. Colours that do not converge, such
    as those of the sigmoid near white in coarse cells, start again from grey.
    """
    forward = forward_map(model, data.sensor.wavelengths, data.sensor.matrix)
    multipliers, target, distance = _reach(data, model, forward, np.array(start.T, order="C"), rgb)
    failed = np.flatnonzero(distance > data.threshold)
    if failed.size:
        from_grey = np.zeros((len(multipliers), failed.size))
        better = _descend(model, forward, from_grey, target[:, failed]) < distance[failed]
        multipliers[:, failed[better]] = from_grey[:, better]
    return multipliers.T


def change_to_rgb(data: CubeData, reflectances: Array, rgb: Array) -> Array:
    """Find the multipliers (n, C) to add to the linear part of reflectances (n, N) that gives them linear RGB (n, 3).

    The reflectances, at the wavelengths of the sensor, need not be of the model: mixtures are not. Those that have
    their colour do not change, and the others continuously. Unrealisable colours are replaced as by `refine_to_rgb`.
    """
    forward = forward_map(data.model, data.sensor.wavelengths, data.sensor.matrix)
    linear = data.model.unsquash(np.array(reflectances.T, order="C"))
    return _reach(data, data.model, forward, np.zeros((data.model.count, len(rgb))), rgb, linear).multipliers.T


class _Reached(NamedTuple):
    """Multipliers (C, n), the linear RGB (3, n) that they were moved to, and distances (n,) from it."""

    multipliers: Array
    target: Array
    distance: Array


def _reach(
    data: CubeData, model: Model, forward: ForwardMap, start: Array, rgb: Array, fixed: Array | None = None
) -> _Reached:
    """Move multipliers (C, n) to linear RGB (n, 3); what is not reached may be unrealisable and is moved inside."""
    multipliers, target = start.copy(), np.array(rgb.T, order="C")
    distance = _descend(model, forward, multipliers, target, fixed)
    failed = np.flatnonzero(distance > data.threshold)
    if failed.size and data.inexact_cells is not None:
        inside = within_solid(data, rgb[failed])
        moved = failed[(inside != rgb[failed]).any(axis=1)]
        target[:, failed] = inside.T
        again = start[:, moved].copy()
        part = None if fixed is None else fixed[:, moved]
        distance[moved] = _descend(model, forward, again, target[:, moved], part)
        multipliers[:, moved] = again
    return _Reached(multipliers, target, distance)


def within_solid(data: CubeData, rgb: Array) -> Array:
    """Return the linear RGB (n, 3) to which unrealisable colours are moved; others are unchanged.

    Half of the threshold inside the object-colour solid, on the line to the grey of the same luminance, as
    unrealisable points of the lattice (`uplift.fit.unrealisable`).
    """
    sensor = data.sensor
    return toward_grey(solid(sensor.matrix), sensor.grey(rgb), rgb, data.threshold / 2)


def _descend(model: Model, forward: ForwardMap, multipliers: Array, target: Array, fixed: Array | None = None) -> Array:
    """Move multipliers (C, n) in place towards linear RGB (3, n) and return the final distances (n,).

    A fixed linear part (N, n) may be added to that of the multipliers.
    """

    def linear_part(columns: slice | Indices) -> Array:
        linear = matmul_columns(forward.basis, multipliers[:, columns])
        return linear if fixed is None else linear + fixed[:, columns]

    state = _DescentState(multipliers, np.empty_like(target), np.zeros(target.shape[1]))
    for first in range(0, target.shape[1], BLOCK_COLUMNS):
        block = slice(first, first + BLOCK_COLUMNS)
        linear = linear_part(block)
        state.off[:, block] = target[:, block] - matmul_columns(forward.sensor, model.squash(linear))
        _move(model, forward, state, block, linear)
    for _ in range(MAX_STEPS - 1):
        pending = np.flatnonzero(state.distance > TOLERANCE)
        if not pending.size:
            break
        for first in range(0, pending.size, BLOCK_COLUMNS):
            columns = pending[first : first + BLOCK_COLUMNS]
            _move(model, forward, state, columns, linear_part(columns))
    return state.distance


class _DescentState(NamedTuple):
    """Multipliers (C, n), residual (3, n) and damping (n,), changed in place."""

    multipliers: Array
    off: Array
    damping: Array

    @property
    def distance(self) -> Array:
        return np.asarray(np.abs(self.off).max(axis=0))


def _move(model: Model, forward: ForwardMap, state: _DescentState, columns: slice | Indices, linear: Array) -> None:
    """Take one step of some columns with linear part (N, k); steps that do not reduce the residual are rejected."""
    current, off, damping = state.multipliers[:, columns], state.off[:, columns], state.damping[columns]
    with np.errstate(over="ignore", invalid="ignore"):  # overflowing steps are rejected
        change = step(model, forward, linear, off, damping)
        trial = current + change
        difference = model.squash_difference(linear, matmul_columns(forward.basis, change))
        trial_off = off - matmul_columns(forward.sensor, difference)
    better = (trial_off**2).sum(axis=0) < (off**2).sum(axis=0)
    better &= np.abs(trial).max(axis=0) <= MAX_MULTIPLIER
    state.multipliers[:, columns] = np.where(better, trial, current)
    state.off[:, columns] = np.where(better, trial_off, off)
    state.damping[columns] = np.where(better, damping / 16, 4 * damping + FIRST_DAMPING)


def step(model: Model, forward: ForwardMap, linear: Array, off: Array, damping: Array) -> Array:
    """Minimum-norm step (C, n) from the linear part (N, n) and residual (3, n), spectra as columns."""
    jacobian = matmul_columns(forward.products.T, model.slope(linear)).reshape(3, len(forward.root), -1)
    gram = [[np.einsum("cn,cn->n", jacobian[a], jacobian[b]) for b in range(a + 1)] for a in range(3)]
    y = solve_3x3(gram, damping * (gram[0][0] + gram[1][1] + gram[2][2]), off)
    return matmul_columns(forward.root, np.einsum("an,acn->cn", np.stack(y), jacobian))
