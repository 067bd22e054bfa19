"""A cube as the plain arrays that the kernel reads: cells by bins, boxes by cell, and what nodes carry."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.lattice import Lattice
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lookup.node_table import NodeTable

BINS = 4096
"""Even bins of [0, 1]; one holds a node at the most, for all but the finest lattices."""

Places = NDArray[np.int32]


class Grid(NamedTuple):
    """Arrays alone, so that JAX passes them through. Row E of boxes and of ``atlas`` stands for no entry."""

    nodes: Any
    """(dim + 1,) of the axis, and infinity."""
    bins: Any
    """(BINS + 1,) the last node before each bin."""
    crowd: Any
    """(M,) nothing but its length, the most nodes that a bin holds: a shape, so that it is known when compiling."""
    candidates: Any
    """(K, dim³) entries whose boxes touch each cell, E where no more do."""
    boxes: Any
    """(E + 1, 3, 3) middle, and one over the room below and above it, linear RGB."""
    lattice: Any
    """(dim³, N) what lattice points carry, float32; NaN where they are absent."""
    atlas: Any
    """(E + 1, N) what entries carry, float32."""
    limits: Any
    """(2,) least and most of what is carried."""


def grid(table: NodeTable) -> Grid:
    """The arrays of a table's cube."""
    lattice, pins = table.data.lattice, table.data.entry_boxes
    bins, crowd = _bins(lattice)
    carried = np.concatenate([table.lattice.ravel(), table.atlas.ravel()])
    return Grid(
        np.append(lattice.nodes, np.inf),
        bins,
        np.zeros(crowd),
        _candidates(pins),
        _boxes(pins),
        table.lattice,
        np.concatenate([table.atlas, np.zeros_like(table.lattice[:1])]),
        np.array([np.nanmin(carried), np.nanmax(carried)]),
    )


def _bins(lattice: Lattice) -> tuple[Places, int]:
    """The last node before each bin, and how many nodes a bin holds at the most.

    Truncation puts nodes and colours into bins alike, so that no colour is taken for the far side of a node.
    """
    bins = (lattice.nodes * BINS).astype(np.int64)
    before = np.searchsorted(bins, np.arange(BINS + 1), side="left") - 1
    return np.maximum(before, 0).astype(np.int32), int(np.bincount(bins).max())


def _candidates(pins: EntryBoxes) -> Places:
    cells, entries = pins.cells
    numbers, first, count = np.unique(cells, return_index=True, return_counts=True)
    candidates = np.full((count.max(initial=0), pins.lattice.size), len(pins.rgb), dtype=np.int32)
    for turn, row in enumerate(candidates):
        more: Indices = np.flatnonzero(count > turn)
        row[numbers[more]] = entries[first[more] + turn]
    return candidates


def _boxes(pins: EntryBoxes) -> Array:
    low, high = pins.faces
    below, above = (
        np.divide(1, room, out=np.zeros_like(room), where=room > 0)
        for room in (pins.rgb - low, high - pins.rgb)
    )
    nowhere = np.array([[[-1.0] * 3, [1.0] * 3, [1.0] * 3]])
    return np.concatenate([np.stack([pins.rgb, below, above], axis=1), nowhere])
