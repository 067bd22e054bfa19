"""Millions of colours: a cube prepared once for textures, then queried through JAX, on
CPU or accelerator.

The first call compiles. For a few thousand colours `uplift.Cube` is faster. Geometry is
float64, as entry boxes may be small, values and weights are float32. Functions raise
`OptionError` for invalid arguments.
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.colorimetry.sensor import Sensor, as_rgb
from uplift.common.arrays import Floats
from uplift.common.compilation import compiled
from uplift.common.machine import require_xla
from uplift.common.text import pluralise
from uplift.lookup.blocks import (
    as_coefficient_count,
    as_colours,
    as_thread_count,
    as_wavelengths,
    blockwise,
)
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import require_covered
from uplift.lookup.interpolate_jax import Grid, interpolate, make_grid
from uplift.lookup.node_table import Exact, NodeTable, tabulate, tabulate_coefficients

__all__ = ["Sampler", "coefficients", "spectra"]

CHUNKS = (1 << 16, 1 << 12)
"""Rows per chunk: two shapes, so that little is compiled; the smaller one is for short
inputs.
"""
ACCELERATOR_CHUNKS = (1 << 20, 1 << 12)
"""The same for an accelerator, which waits at the start and end of each chunk."""


@compiled
def _clipped(grid: Grid, rgb: jax.Array) -> jax.Array:
    """Interpolate values (n, N), float32, at linear RGB (n, 3), float64 in [0, 1]."""
    return jnp.clip(interpolate(grid, rgb), grid.limits[0], grid.limits[1])


def _chunks() -> tuple[int, int]:
    return CHUNKS if jax.default_backend() == "cpu" else ACCELERATOR_CHUNKS


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
            self._chunk,
            as_rgb(rgb),
            width,
            np.float32,
            threads=self.threads,
            block=_chunks()[0],
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle arrays of numpy: JAX would restore those of float64 as float32."""
        return _on_device, (
            self.sensor,
            jax.tree.map(np.asarray, self.grid),
            self.threads,
            self.exact,
        )

    @property
    def nbytes(self) -> int:
        """Memory of the arrays in bytes."""
        return sum(array.nbytes for array in self.grid)

    def _chunk(self, rgb: NDArray[Any]) -> Floats:
        require_xla()
        colours = as_colours(rgb, self.sensor)
        size = min(size for size in _chunks() if size >= len(colours))
        missing = size - len(colours)
        padded = np.pad(colours, ((0, missing), (0, 0))) if missing else colours
        with jax.enable_x64(True):
            values = np.asarray(_clipped(self.grid, padded))[: len(colours)]
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

    The table takes 4 · dim³ · N bytes. A colour reads four of its rows (16 · N bytes),
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


def _sampler(table: NodeTable, threads: int) -> Sampler:
    """Put the arrays of a table on the device of JAX."""
    grid = make_grid(table, np.float64)
    return _on_device(table.data.sensor, grid, threads, table.exact)


def _on_device(
    sensor: Sensor, grid: Grid, threads: int, exact: Exact | None
) -> Sampler:
    require_xla()
    with jax.enable_x64(True):
        return Sampler(sensor, jax.device_put(grid), threads, exact)
