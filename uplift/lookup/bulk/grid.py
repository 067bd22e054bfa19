"""The arrays of a cube that the compiled kernel reads."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.lattice import EntryBoxes, Lattice
from uplift.lookup.node_table import NodeTable

BINS = 4096
"""Even bins of [0, 1]. A bin contains at most one node, except in the finest lattices."""

Places = NDArray[np.int32]


class Grid(NamedTuple):
    """Arrays only, a pytree for JAX. Row E of ``boxes`` and ``atlas`` stands for no entry."""

    nodes: Any
    """(dim + 1,) axis nodes, and infinity."""
    bins: Any
    """(BINS + 1,) the last node before each bin."""
    max_nodes_per_bin: Any
    """(M,) zeros: only the length matters. As a shape it is known when compiling."""
    candidates: Any
    """(K, dim³) entries whose boxes touch each cell, padded with E."""
    boxes: Any
    """(E + 1, 3, 3) centre in linear RGB, and reciprocals of the distances to the lower and upper faces."""
    lattice: Any
    """(dim³, N) values of the lattice points, float32; NaN at absent points."""
    atlas: Any
    """(E + 1, N) values of the entries, float32."""
    limits: Any
    """(2,) smallest and largest value."""


def make_grid(table: NodeTable) -> Grid:
    """Make the arrays of a table."""
    lattice, boxes = table.data.lattice, table.data.entry_boxes
    bins, most = _bins(lattice)
    values = np.concatenate([table.lattice.ravel(), table.atlas.ravel()])
    return Grid(
        np.append(lattice.nodes, np.inf),
        bins,
        np.zeros(most),
        _candidates(boxes),
        _boxes(boxes),
        table.lattice,
        np.concatenate([table.atlas, np.zeros_like(table.lattice[:1])]),
        np.array([np.nanmin(values), np.nanmax(values)]),
    )


def _bins(lattice: Lattice) -> tuple[Places, int]:
    """The last node before each bin, and the largest number of nodes in a bin.

    Nodes and colours are truncated alike, so that no colour moves to the other side of a node.
    """
    bins = (lattice.nodes * BINS).astype(np.int64)
    before = np.searchsorted(bins, np.arange(BINS + 1), side="left") - 1
    return np.maximum(before, 0).astype(np.int32), int(np.bincount(bins).max())


def _candidates(boxes: EntryBoxes) -> Places:
    cells, entries = boxes.cells
    numbers, first, count = np.unique(cells, return_index=True, return_counts=True)
    candidates = np.full((count.max(initial=0), boxes.lattice.size), len(boxes.rgb), dtype=np.int32)
    for turn, row in enumerate(candidates):
        more: Indices = np.flatnonzero(count > turn)
        row[numbers[more]] = entries[first[more] + turn]
    return candidates


def _boxes(boxes: EntryBoxes) -> Array:
    low, high = boxes.faces
    below, above = (
        np.divide(1, room, out=np.zeros_like(room), where=room > 0) for room in (boxes.rgb - low, high - boxes.rgb)
    )
    none = np.array([[[-1.0] * 3, [1.0] * 3, [1.0] * 3]])
    return np.concatenate([np.stack([boxes.rgb, below, above], axis=1), none])
