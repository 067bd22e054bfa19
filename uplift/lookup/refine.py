"""Move multipliers to exact colours by minimum-norm steps (`uplift.models.minimum_norm`). Needs numpy only.

Spectra are columns here, so that all arithmetic runs along contiguous memory. A spectrum is evaluated once; later steps
add its changes, which need no arc tangents of large numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

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

    Colours that do not converge, such as those of the sigmoid near white in coarse cells, start again from grey.
    """
    forward = forward_map(model, data.sensor.wavelengths, data.sensor.matrix)
    multipliers, target = np.array(start.T, order="C"), np.array(rgb.T, order="C")
    distance = _descend(model, forward, multipliers, target)
    failed = np.flatnonzero(distance > data.threshold)
    if failed.size:
        from_grey = np.zeros((len(multipliers), failed.size))
        better = _descend(model, forward, from_grey, target[:, failed]) < distance[failed]
        multipliers[:, failed[better]] = from_grey[:, better]
    return multipliers.T


def _descend(model: Model, forward: ForwardMap, multipliers: Array, target: Array) -> Array:
    """Move multipliers (C, n) in place towards linear RGB (3, n) and return the final distances (n,)."""
    state = _DescentState(multipliers, np.empty_like(target), np.zeros(target.shape[1]))
    for first in range(0, target.shape[1], BLOCK_COLUMNS):
        block = slice(first, first + BLOCK_COLUMNS)
        linear = matmul_columns(forward.basis, multipliers[:, block])
        state.off[:, block] = target[:, block] - matmul_columns(forward.sensor, model.squash(linear))
        _move(model, forward, state, block, linear)
    for _ in range(MAX_STEPS - 1):
        pending = np.flatnonzero(state.distance > TOLERANCE)
        if not pending.size:
            break
        for first in range(0, pending.size, BLOCK_COLUMNS):
            columns = pending[first : first + BLOCK_COLUMNS]
            _move(model, forward, state, columns, matmul_columns(forward.basis, multipliers[:, columns]))
    return state.distance


class _DescentState(NamedTuple):
    """Multipliers (C, n), residual (3, n) and damping (n,), changed in place."""

    multipliers: Array
    off: Array
    damping: Array

    @property
    def distance(self) -> Array:
        return np.asarray(np.abs(self.off).max(axis=0))


def _move(
    model: Model, forward: ForwardMap, state: _DescentState, columns: slice | Indices, linear: Array
) -> None:
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
