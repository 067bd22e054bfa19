"""`uplift.lookup.interpolate` in JAX: weighted values of the nodes around colours, as
pure functions of the arrays of a cube.

They can be compiled, batched and differentiated, by colours and by arrays. Colours and
the geometry of the lattice have one type, values and weights another; float32 for both
moves colours by rounding, in small entry boxes visibly so.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import DTypeLike, NDArray

from uplift.common.arrays import Array, Indices
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lattice.lattice import tetrahedron
from uplift.lookup.node_table import NodeTable

Places = NDArray[np.int32]


class Grid(NamedTuple):
    """Arrays only, a pytree for JAX. Row E of ``boxes`` and ``atlas`` stands for no
    entry.
    """

    nodes: jax.Array
    """(dim,) axis nodes."""
    candidates: jax.Array
    """(K, dim³) entries whose boxes touch each cell, padded with E."""
    boxes: jax.Array
    """(E + 1, 3, 3) centre in linear RGB, and reciprocals of the distances to the lower
    and upper faces.
    """
    lattice: jax.Array
    """(dim³, N) values of the lattice; NaN at absent nodes."""
    atlas: jax.Array
    """(E + 1, N) values of the entries."""
    limits: jax.Array
    """(2,) smallest and largest value."""


def make_grid(table: NodeTable, dtype: DTypeLike) -> Grid:
    """Make the arrays, in numpy, of a table; colours and nodes will be of a type."""
    boxes = table.data.entry_boxes
    values = np.concatenate([table.lattice.ravel(), table.atlas.ravel()])
    arrays: tuple[Any, ...] = (
        table.data.lattice.nodes.astype(dtype),
        _candidates(boxes),
        _boxes(boxes).astype(dtype),
        table.lattice,
        np.concatenate([table.atlas, np.zeros_like(table.lattice[:1])]),
        np.array([np.nanmin(values), np.nanmax(values)]),
    )
    return Grid(*arrays)


def _candidates(boxes: EntryBoxes) -> Places:
    cells, entries = boxes.cells
    numbers, first, count = np.unique(cells, return_index=True, return_counts=True)
    candidates = np.full(
        (count.max(initial=0), boxes.lattice.size), len(boxes.rgb), dtype=np.int32
    )
    for turn, row in enumerate(candidates):
        more: Indices = np.flatnonzero(count > turn)
        row[numbers[more]] = entries[first[more] + turn]
    return candidates


def _boxes(boxes: EntryBoxes) -> Array:
    low, high = boxes.faces
    below, above = (
        np.divide(1, room, out=np.zeros_like(room), where=room > 0)
        for room in (boxes.rgb - low, high - boxes.rgb)
    )
    none = np.array([[[-1.0] * 3, [1.0] * 3, [1.0] * 3]])
    return np.concatenate([np.stack([boxes.rgb, below, above], axis=1), none])


def interpolate(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Interpolate values (n, N) at linear RGB (n, 3) in [0, 1] of the type of the
    nodes.
    """
    return _with_entries(grid, rgb) if len(grid.candidates) else _tetrahedral(grid, rgb)


def evaluated_cells(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Return the numbers (n,) of the cells in which the lattice is evaluated for linear
    RGB (n, 3).
    """
    exit_rgb = _box_hits(grid, rgb)[0] if len(grid.candidates) else rgb
    return _number(grid, _cell(grid, exit_rgb))


def _rows(array: jax.Array, index: jax.Array) -> jax.Array:
    """``array[index]`` without bounds checks."""
    return array.at[index].get(mode="promise_in_bounds", wrap_negative_indices=False)


def _cell(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Lowest corner (n, 3)."""
    # Comparison with all nodes is faster than a search, next to the values.
    before = (rgb[..., None] >= grid.nodes).sum(axis=-1, dtype=jnp.int32)
    return jnp.clip(before - 1, 0, len(grid.nodes) - 2)


def _number(grid: Grid, position: jax.Array) -> jax.Array:
    dim = len(grid.nodes)
    return (position[:, 0] * dim + position[:, 1]) * dim + position[:, 2]


def _with_entries(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Interpolate the lattice and, in the box of an entry, the entry
    (`uplift.lattice.entry_boxes`).
    """
    exit_rgb, entry, weight = _box_hits(grid, rgb)
    return weight[:, None] * _tetrahedral(grid, exit_rgb) + (1 - weight)[
        :, None
    ] * _rows(grid.atlas, entry)


def _box_hits(grid: Grid, rgb: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Colours (n, 3) at which to evaluate the lattice, the entry (n,) of each, and the
    weight (n,) of the lattice.
    """
    cell = _number(grid, _cell(grid, rgb))

    def turn(
        count: jax.Array, best: tuple[jax.Array, jax.Array]
    ) -> tuple[jax.Array, jax.Array]:
        entry, weight = best
        candidate = _rows(grid.candidates[count], cell)
        centre, below, above = jnp.moveaxis(_rows(grid.boxes, candidate), 1, 0)
        # x = (1 − t) e + t y: t is the largest fraction, over the axes, of the way from
        # e to the face that x moves to.
        ray = rgb - centre
        reached = jnp.where(ray > 0, ray * above, -ray * below).max(axis=1)
        inside = reached < 1
        return jnp.where(inside, candidate, entry), jnp.where(inside, reached, weight)

    # Boxes do not overlap, so that at most one candidate contains a colour.
    none = jnp.full(len(rgb), len(grid.atlas) - 1, dtype=jnp.int32)
    entry, weight = jax.lax.fori_loop(
        0, len(grid.candidates), turn, (none, jnp.ones(len(rgb), rgb.dtype))
    )
    centre = _rows(grid.boxes[:, 0], entry)
    moved = (weight > 0) & (weight < 1)
    ray = (rgb - centre) / jnp.where(moved, weight, 1)[:, None]
    exit_rgb = jnp.where(moved[:, None], jnp.clip(centre + ray, 0, 1), rgb)
    return exit_rgb, entry, weight.astype(grid.atlas.dtype)


def _tetrahedral(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Σ over the corners of `Lattice.tetrahedra` of their weights times their
    values.
    """
    low = _cell(grid, rgb)
    start = _rows(grid.nodes, low)
    along = (rgb - start) / (_rows(grid.nodes, low + 1) - start)
    strides = len(grid.nodes) ** 2, len(grid.nodes), 1
    fractions = along.astype(grid.lattice.dtype).T
    steps, weights = tetrahedron(fractions, strides, jnp.where)
    corner = _number(grid, low)
    total = jnp.zeros((len(rgb), grid.lattice.shape[1]), dtype=grid.lattice.dtype)
    for step, weight in zip(steps, weights, strict=True):
        total += weight[:, None] * _rows(grid.lattice, corner + step)
    return total
