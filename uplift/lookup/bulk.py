"""Millions of colours: a cube prepared once for textures, then queried through JAX, on
CPU or accelerator.

The first call compiles. For a few thousand colours `uplift.Cube` is faster. This is
`uplift.lookup.interpolate` in JAX: geometry is float64, as entry boxes may be small,
values and weights are float32. Functions raise `OptionError` for invalid arguments.
"""

from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.colorimetry import Sensor, as_rgb
from uplift.common.arrays import Array, Floats, Indices
from uplift.common.machine import require_memory_of_xla
from uplift.common.text import pluralise
from uplift.lattice import EntryBoxes, Lattice
from uplift.lookup.blocks import (
    as_coefficient_count,
    as_colours,
    as_thread_count,
    as_wavelengths,
    blockwise,
)
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import require_covered
from uplift.lookup.node_table import Exact, NodeTable, tabulate, tabulate_coefficients

__all__ = ["Sampler", "coefficients", "spectra"]

BINS = 4096
"""Even bins of [0, 1]. A bin contains at most one node, except in the finest lattices.
"""
CHUNKS = (1 << 16, 1 << 12)
"""Rows per chunk: two shapes, so that little is compiled; the smaller one is for short
inputs.
"""

Places = NDArray[np.int32]


class Grid(NamedTuple):
    """Arrays only, a pytree for JAX. Row E of ``boxes`` and ``atlas`` stands for no
    entry.
    """

    nodes: Any
    """(dim + 1,) axis nodes, and infinity."""
    bins: Any
    """(BINS + 1,) the last node before each bin."""
    max_nodes_per_bin: Any
    """(M,) zeros: only the length matters. As a shape it is known when compiling."""
    candidates: Any
    """(K, dim³) entries whose boxes touch each cell, padded with E."""
    boxes: Any
    """(E + 1, 3, 3) centre in linear RGB, and reciprocals of the distances to the lower
    and upper faces.
    """
    lattice: Any
    """(dim³, N) values of the lattice, float32; NaN at absent nodes."""
    atlas: Any
    """(E + 1, N) values of the entries, float32."""
    limits: Any
    """(2,) smallest and largest value."""


def _sampler(table: NodeTable, threads: int) -> "Sampler":
    """Put the arrays of a table on the device of JAX."""
    lattice = table.data.lattice
    boxes = table.data.entry_boxes
    bins, most = _bins(lattice)
    values = np.concatenate([table.lattice.ravel(), table.atlas.ravel()])
    grid = Grid(
        np.append(lattice.nodes, np.inf),
        bins,
        np.zeros(most),
        _candidates(boxes),
        _boxes(boxes),
        table.lattice,
        np.concatenate([table.atlas, np.zeros_like(table.lattice[:1])]),
        np.array([np.nanmin(values), np.nanmax(values)]),
    )
    return _on_device(table.data.sensor, grid, threads, table.exact)


def _bins(lattice: Lattice) -> tuple[Places, int]:
    """The last node before each bin, and the largest number of nodes in a bin.

    Nodes and colours are truncated alike, so that no colour moves to the other side of
    a node.
    """
    bins = (lattice.nodes * BINS).astype(np.int64)
    before = np.searchsorted(bins, np.arange(BINS + 1), side="left") - 1
    return np.maximum(before, 0).astype(np.int32), int(np.bincount(bins).max())


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


@jax.jit
def _interpolate(grid: Grid, rgb: jax.Array) -> jax.Array:
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
    """Interpolate the lattice and, in the box of an entry, the entry
    (`uplift.lattice.entry_boxes`).
    """
    exit_rgb, entry, weight = _box_hits(grid, rgb)
    return weight[:, None] * _trilinear(grid, exit_rgb) + (1 - weight)[:, None] * _rows(
        grid.atlas, entry
    )


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
        0, len(grid.candidates), turn, (none, jnp.ones(len(rgb)))
    )
    centre = _rows(grid.boxes[:, 0], entry)
    moved = (weight > 0) & (weight < 1)
    ray = (rgb - centre) / jnp.where(moved, weight, 1)[:, None]
    exit_rgb = jnp.where(moved[:, None], jnp.clip(centre + ray, 0, 1), rgb)
    return exit_rgb, entry, weight.astype(jnp.float32)


def _trilinear(grid: Grid, rgb: jax.Array) -> jax.Array:
    low = _cell(grid, rgb)
    start = _rows(grid.nodes, low)
    # Σ over the corners of the product of t or 1 − t along the axes, times their values
    along = ((rgb - start) / (_rows(grid.nodes, low + 1) - start)).astype(jnp.float32)
    sides = jnp.stack([1 - along, along])
    total = jnp.zeros((len(rgb), grid.lattice.shape[1]), dtype=jnp.float32)
    for r, g, b in product((0, 1), repeat=3):
        weight = sides[r, :, 0] * sides[g, :, 1] * sides[b, :, 2]
        corner = _number(grid, low + jnp.array([r, g, b], dtype=jnp.int32))
        total += weight[:, None] * _rows(grid.lattice, corner)
    return total


@dataclass(frozen=True, eq=False, repr=False)
class Sampler:
    """Interpolate values of the nodes of a cube. Made by `spectra` or `coefficients`.

    Parameters
    ----------
    sensor : Sensor
        RGB space of the colours.
    grid : Grid
        Arrays of the cube, on the device of JAX.
    threads : int
        Number of threads; each processes a chunk at a time.
    exact : function, optional
        If some nodes have not their own colours: finds the colours around them and
        their values by numpy.
    """

    sensor: Sensor
    grid: Grid
    threads: int
    exact: Exact | None = None

    def __repr__(self) -> str:
        return (
            f"Sampler({pluralise(self.grid.lattice.shape[1], 'value')} per colour, "
            f"{self.nbytes / 1e6:.1f} MB)"
        )

    def __call__(self, rgb: ArrayLike) -> Floats:
        """Interpolate values (…, N) at linear RGB (…, 3) in [0, 1]; `ColourError` as in
        `Cube.reflectance`.
        """
        width = self.grid.lattice.shape[1]
        return blockwise(
            self._chunk, as_rgb(rgb), width, np.float32, self.threads, CHUNKS[0]
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle arrays of numpy: JAX would restore those of float64 as float32."""
        return _on_device, (
            self.sensor,
            Grid(*map(np.asarray, self.grid)),
            self.threads,
            self.exact,
        )

    @property
    def nbytes(self) -> int:
        """Memory of the arrays in bytes."""
        return sum(array.nbytes for array in self.grid)

    def _chunk(self, rgb: NDArray[Any]) -> Floats:
        colours = as_colours(rgb, self.sensor)
        size = min(size for size in CHUNKS if size >= len(colours))
        missing = size - len(colours)
        padded = np.pad(colours, ((0, missing), (0, 0))) if missing else colours
        with jax.enable_x64(True):
            values = np.asarray(_interpolate(self.grid, padded))[: len(colours)]
        require_covered(~np.isnan(values[:, 0]), colours)  # absent nodes make NaN
        if self.exact is not None:
            rows, moved = self.exact(colours)
            if rows.size:
                values = values.copy()
                values[rows] = moved
        return values


def spectra(
    cube: Cube, wavelengths: ArrayLike | None = None, *, threads: int = 2
) -> Sampler:
    """Prepare a cube for reflectances in mode ``spectra``, accurate to 1e-6.

    The table takes 4 · dim³ · N bytes. A colour reads eight of its rows (32 · N bytes),
    in an entry box one more.

    Parameters
    ----------
    cube : Cube
        The cube.
    wavelengths : array_like, shape (N,), optional
        Wavelengths in nm, by default those of the sensor.
    threads : int, default 2
        Number of threads.

    Returns
    -------
    Sampler
        From linear RGB (..., 3) to reflectances (..., N).
    """
    count = as_thread_count(threads)
    return _sampler(
        tabulate(
            cube.data, as_wavelengths(wavelengths, cube.wavelengths), np.float32, count
        ),
        count,
    )


def coefficients(cube: Cube, count: int | None = None, *, threads: int = 2) -> Sampler:
    """Prepare a cube for coefficients of its model, in float32.

    Parameters
    ----------
    cube : Cube
        The cube.
    count : int, optional
        Coefficients per spectrum, as in `Cube.coefficients`.
    threads : int, default 2
        Number of threads.

    Returns
    -------
    Sampler
        From linear RGB (..., 3) to coefficients (..., count).
    """
    width = as_coefficient_count(count, cube.data)
    threads = as_thread_count(threads)
    return _sampler(
        tabulate_coefficients(cube.data, width, np.float32, threads), threads
    )


def _on_device(
    sensor: Sensor, grid: Grid, threads: int, exact: Exact | None
) -> Sampler:
    require_memory_of_xla()
    with jax.enable_x64(True):
        return Sampler(sensor, jax.device_put(grid), threads, exact)
