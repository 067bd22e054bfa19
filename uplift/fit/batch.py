"""Batches of rows: in chunks by numpy or, for large lattices, as programs of JAX; integrals of the moments of batches.

Importing and tracing JAX takes longer than numpy does for a small lattice (docs/performance.md).
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from uplift.common.arrays import Array, blocks
from uplift.models import Moments
from uplift.models.arithmetic import TOGETHER, arctan
from uplift.models.duality import integrate, moments_from_multipliers
from uplift.models.model import Model

CHUNK = 512
"""Rows that numpy computes at a time: their temporary arrays fit into the cache. A multiple of `TOGETHER`."""
MAX_NODES = 256
"""Larger rules of integration, which few spectra need, are not worth compiling."""
PART_NODES = 97
"""Nodes of the first rule. Other rules run in parts of as many: one program for all."""
CONVERGED = 1e-6
"""For lattices: moments differ by some 1e-9 at most, a sixtieth of the rounding to single precision."""


def map_batches(function: Callable[..., Any], constants: Any, *arrays: Any, compiled: bool = False) -> Any:
    """Apply a function to constants and to trees of arrays (n, …), n > 0, and join the arrays that it returns.

    Trees are tuples and dicts. The function works on the arrays of numpy or, compiled, of JAX. What it returns for a
    row must not depend on other rows; the last row is repeated, as products of numpy round rows `TOGETHER` alike.
    """
    if compiled:
        from uplift.fit import compiled as programs

        return programs.map_batches(function, constants, *arrays)
    parts, count = [], len(arrays[0])
    for rows in blocks(count, CHUNK):
        own = np.minimum(np.arange(rows.start, rows.stop + -rows.stop % TOGETHER), count - 1)
        part = function(constants, *_map(lambda array, own=own: array[own], arrays))
        parts.append(_map(lambda array, rows=rows: array[: rows.stop - rows.start], part))
    return _map(lambda *joined: np.concatenate(joined), *parts)


def _map(function: Callable[..., Any], *trees: Any) -> Any:
    """Apply a function to the arrays of trees of one structure."""
    first = trees[0]
    if isinstance(first, dict):
        return {name: _map(function, *(tree[name] for tree in trees)) for name in first}
    if isinstance(first, tuple):
        return tuple(_map(function, *each) for each in zip(*trees, strict=True))
    return function(*trees)


def to_storage(model: Model, multipliers: Array, compiled: bool = False) -> Array:
    """Coefficients (n, C) of many multipliers (n, C): `Model.to_storage`, less precise and several times faster."""
    if isinstance(model, Moments):
        return moments_from_multipliers(multipliers, partial(_integrate, compiled=compiled), CONVERGED)
    return model.to_storage(multipliers)


def _integrate(multipliers: Array, synthesis: Array, analysis: Array, compiled: bool) -> Array:
    """Compute `uplift.models.duality.integrate`."""
    count, (nodes, columns) = len(synthesis), analysis.shape
    if nodes > MAX_NODES + 1 or not len(multipliers):
        return integrate(multipliers, synthesis, analysis)
    if not compiled:
        return np.asarray(map_batches(_weighted, (synthesis, analysis), multipliers))
    moments = np.zeros((len(multipliers), columns))
    for first in range(0, nodes, PART_NODES):
        # Each part is as large as the first rule, which has two sets of moments: the rest has no weight.
        part = slice(first, first + PART_NODES)
        points, weights = np.zeros((count, PART_NODES)), np.zeros((PART_NODES, 2 * count))
        points[:, : nodes - first], weights[: nodes - first, :columns] = synthesis[:, part], analysis[part]
        moments += map_batches(_weighted, (points, weights), multipliers, compiled=True)[:, :columns]
    return moments


def _weighted(rule: tuple[Any, Any], multipliers: Any) -> Any:
    synthesis, analysis = rule
    return (0.5 + arctan(multipliers @ synthesis) / np.pi) @ analysis
