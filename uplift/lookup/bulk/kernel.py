"""Interpolation of one chunk of colours, compiled once per shape: `uplift.lookup.nodes` in JAX.

Geometry is float64, as entry boxes may be small. Values and weights are float32.
"""

from __future__ import annotations

from itertools import product

import jax
import jax.numpy as jnp

from uplift.lookup.bulk.grid import BINS, Grid


@jax.jit
def interpolate(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Interpolate values (n, N), float32, at linear RGB (n, 3), float64 in [0, 1]."""
    values = _with_entries(grid, rgb) if len(grid.candidates) else _trilinear(grid, rgb)
    return jnp.clip(values, grid.limits[0], grid.limits[1])


def _rows(array: jax.Array, index: jax.Array) -> jax.Array:
    """``array[index]`` without bounds checks."""
    return array.at[index].get(mode="promise_in_bounds", wrap_negative_indices=False)


def _cell(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Lowest corner (n, 3)."""
    low = _rows(grid.bins, (rgb * BINS).astype(jnp.int32))
    for _ in range(len(grid.max_nodes_per_bin)):
        low = low + (rgb >= _rows(grid.nodes, low + 1))
    return jnp.minimum(low, len(grid.nodes) - 3)


def _number(grid: Grid, position: jax.Array) -> jax.Array:
    dim = len(grid.nodes) - 1
    return (position[:, 0] * dim + position[:, 1]) * dim + position[:, 2]


def _with_entries(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Interpolate the lattice and, in the box of an entry, the entry (`uplift.lattice.entry_boxes`)."""
    exit_rgb, entry, weight = _box_hits(grid, rgb)
    return weight[:, None] * _trilinear(grid, exit_rgb) + (1 - weight)[:, None] * _rows(grid.atlas, entry)


def _box_hits(grid: Grid, rgb: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Colours (n, 3) at which to evaluate the lattice, the entry (n,) of each, and the weight (n,) of the lattice."""
    cell = _number(grid, _cell(grid, rgb))

    def turn(count: jax.Array, best: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        entry, weight = best
        candidate = _rows(grid.candidates[count], cell)
        centre, below, above = jnp.moveaxis(_rows(grid.boxes, candidate), 1, 0)
        ray = rgb - centre
        reached = jnp.where(ray > 0, ray * above, -ray * below).max(axis=1)
        inside = reached < 1
        return jnp.where(inside, candidate, entry), jnp.where(inside, reached, weight)

    none = jnp.full(len(rgb), len(grid.atlas) - 1, dtype=jnp.int32)
    entry, weight = jax.lax.fori_loop(0, len(grid.candidates), turn, (none, jnp.ones(len(rgb))))
    centre = _rows(grid.boxes[:, 0], entry)
    moved = (weight > 0) & (weight < 1)
    ray = (rgb - centre) / jnp.where(moved, weight, 1)[:, None]
    exit_rgb = jnp.where(moved[:, None], jnp.clip(centre + ray, 0, 1), rgb)
    return exit_rgb, entry, weight.astype(jnp.float32)


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
