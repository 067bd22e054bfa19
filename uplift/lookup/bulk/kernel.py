"""The answer for one chunk of colours, compiled once per shape: what `uplift.lookup.nodes` does, in JAX.

Geometry is float64, for boxes around entries may be small; what nodes carry, and the weights, float32.
"""

from __future__ import annotations

from itertools import product

import jax
import jax.numpy as jnp

from uplift.lookup.bulk.grid import BINS, Grid


@jax.jit
def answer(grid: Grid, rgb: jax.Array) -> jax.Array:
    """(n, N) float32 of linear RGB (n, 3) float64 in [0, 1]: the nodes around, weighted."""
    found = _pinned(grid, rgb) if len(grid.candidates) else _trilinear(grid, rgb)
    return jnp.clip(found, grid.limits[0], grid.limits[1])


def _rows(array: jax.Array, index: jax.Array) -> jax.Array:
    """``array[index]`` for indices that are known to be good, so that none is checked."""
    return array.at[index].get(mode="promise_in_bounds", wrap_negative_indices=False)


def _cell(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Lowest corner (n, 3)."""
    low = _rows(grid.bins, (rgb * BINS).astype(jnp.int32))
    for _ in range(len(grid.crowd)):
        low = low + (rgb >= _rows(grid.nodes, low + 1))
    return jnp.minimum(low, len(grid.nodes) - 3)


def _number(grid: Grid, position: jax.Array) -> jax.Array:
    dim = len(grid.nodes) - 1
    return (position[:, 0] * dim + position[:, 1]) * dim + position[:, 2]


def _pinned(grid: Grid, rgb: jax.Array) -> jax.Array:
    """The lattice's part and, in the box of an entry, the entry's (`uplift.lattice.entry_boxes`)."""
    away, entry, share = _mixture(grid, rgb)
    return share[:, None] * _trilinear(grid, away) + (1 - share)[:, None] * _rows(grid.atlas, entry)


def _mixture(grid: Grid, rgb: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Colours (n, 3) to ask the lattice for, the entry (n,) that each mixes with, the lattice's share (n,)."""
    cell = _number(grid, _cell(grid, rgb))

    def turn(count: jax.Array, best: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        entry, share = best
        candidate = _rows(grid.candidates[count], cell)
        middle, below, above = jnp.moveaxis(_rows(grid.boxes, candidate), 1, 0)
        ray = rgb - middle
        reached = jnp.where(ray > 0, ray * above, -ray * below).max(axis=1)
        inside = reached < 1
        return jnp.where(inside, candidate, entry), jnp.where(inside, reached, share)

    none = jnp.full(len(rgb), len(grid.atlas) - 1, dtype=jnp.int32)
    entry, share = jax.lax.fori_loop(0, len(grid.candidates), turn, (none, jnp.ones(len(rgb))))
    middle = _rows(grid.boxes[:, 0], entry)
    moved = (share > 0) & (share < 1)
    ray = (rgb - middle) / jnp.where(moved, share, 1)[:, None]
    away = jnp.where(moved[:, None], jnp.clip(middle + ray, 0, 1), rgb)
    return away, entry, share.astype(jnp.float32)


def _trilinear(grid: Grid, rgb: jax.Array) -> jax.Array:
    low = _cell(grid, rgb)
    start = _rows(grid.nodes, low)
    along = ((rgb - start) / (_rows(grid.nodes, low + 1) - start)).astype(jnp.float32)
    sides = jnp.stack([1 - along, along])
    total = jnp.zeros((len(rgb), grid.lattice.shape[1]), dtype=jnp.float32)
    for r, g, b in product((0, 1), repeat=3):
        weight = sides[r, :, 0] * sides[g, :, 1] * sides[b, :, 2]
        corner = _number(grid, low + jnp.array([r, g, b], dtype=jnp.int32))
        total += weight[:, None] * _rows(grid.lattice, corner)
    return total
