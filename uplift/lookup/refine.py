"""Multipliers moved to their very colours by steps of least change (`uplift.models.minimum_norm`), in numpy alone.

Spectra are columns here, so that all arithmetic runs along contiguous memory. A colour is evaluated once; from there on
it is followed by what each step changes, which takes no arc tangents of large numbers.
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

REFINED = 1e-8
"""Residual, max |linear RGB|, at which it stops."""
MOST_STEPS = 24
FIRST_DAMPING = 1e-2
"""μ after a full step that did not help; nearly all colours need one full step or two, and no damping."""
COLUMNS = 1024
"""Spectra worked on at a time: what they need stays in the cache."""


def refine_to_rgb(data: CubeData, start: Array, rgb: Array) -> Array:
    """Multipliers ``start`` (n, C) moved to linear RGB (n, 3).

    Where a start is hopeless, as the sigmoid's near white in coarse cells, they start from grey.
    """
    ahead = forward_map(data.model, data.sensor.wavelengths, data.sensor.matrix)
    multipliers, goal = np.array(start.T, order="C"), np.array(rgb.T, order="C")
    distance = _descend(data.model, ahead, multipliers, goal)
    hopeless = np.flatnonzero(distance > data.threshold)
    if hopeless.size:
        again = np.zeros((len(multipliers), hopeless.size))
        better = _descend(data.model, ahead, again, goal[:, hopeless]) < distance[hopeless]
        multipliers[:, hopeless[better]] = again[:, better]
    return multipliers.T


def _descend(model: Model, ahead: ForwardMap, multipliers: Array, goal: Array) -> Array:
    """Move multipliers (C, n) in place, each step only where it helps; distance (n,) from linear RGB (3, n)."""
    way = _Way(multipliers, np.empty_like(goal), np.zeros(goal.shape[1]))
    for first in range(0, goal.shape[1], COLUMNS):
        part = slice(first, first + COLUMNS)
        linear = matmul_columns(ahead.basis, multipliers[:, part])
        way.off[:, part] = goal[:, part] - matmul_columns(ahead.sensor, model.squash(linear))
        _move(model, ahead, way, part, linear)
    for _ in range(MOST_STEPS - 1):
        left = np.flatnonzero(way.distance > REFINED)
        if not left.size:
            break
        for first in range(0, left.size, COLUMNS):
            some = left[first : first + COLUMNS]
            _move(model, ahead, way, some, matmul_columns(ahead.basis, multipliers[:, some]))
    return way.distance


class _Way(NamedTuple):
    """Multipliers (C, n), the residual (3, n) and the damping (n,), changed in place."""

    multipliers: Array
    off: Array
    damping: Array

    @property
    def distance(self) -> Array:
        return np.asarray(np.abs(self.off).max(axis=0))


def _move(model: Model, ahead: ForwardMap, way: _Way, columns: slice | Indices, linear: Array) -> None:
    """One step of some columns, whose linear part is (N, k)."""
    here, off, damping = way.multipliers[:, columns], way.off[:, columns], way.damping[columns]
    with np.errstate(over="ignore", invalid="ignore"):  # steps too far are turned down
        change = step(model, ahead, linear, off, damping)
        there = here + change
        off_there = off - matmul_columns(
            ahead.sensor, model.squash_difference(linear, matmul_columns(ahead.basis, change))
        )
    better = (off_there**2).sum(axis=0) < (off**2).sum(axis=0)
    better &= np.abs(there).max(axis=0) <= MAX_MULTIPLIER
    way.multipliers[:, columns] = np.where(better, there, here)
    way.off[:, columns] = np.where(better, off_there, off)
    way.damping[columns] = np.where(better, damping / 16, 4 * damping + FIRST_DAMPING)


def step(model: Model, ahead: ForwardMap, linear: Array, off: Array, damping: Array) -> Array:
    """`uplift.models.minimum_norm.minimum_norm_step` of columns (C, n): linear part (N, n), residual (3, n)."""
    jacobian = matmul_columns(ahead.products.T, model.slope(linear)).reshape(3, len(ahead.root), -1)
    gram = [[np.einsum("cn,cn->n", jacobian[a], jacobian[b]) for b in range(a + 1)] for a in range(3)]
    y = solve_3x3(gram, damping * (gram[0][0] + gram[1][1] + gram[2][2]), off)
    return matmul_columns(ahead.root, np.einsum("an,acn->cn", np.stack(y), jacobian))
