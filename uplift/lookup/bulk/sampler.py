"""Samplers: the values of a cube's nodes, prepared for many colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax
import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.colorimetry.gamut import as_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise
from uplift.lookup.bulk.kernel import Grid, interpolate, make_grid
from uplift.lookup.interpolate import NodeTable, inexact_rows, require_covered, tabulate, tabulate_coefficients
from uplift.lookup.interpolate import spectra as reflectances
from uplift.lookup.validation import as_coefficient_count, as_thread_count, clip_rounding

CHUNKS = (1 << 16, 1 << 12)
"""Rows per chunk: two shapes, so that little is compiled; the smaller one is for short inputs."""

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False, repr=False)
class Sampler:
    """Interpolate values of the nodes of a cube. Made by `spectra`, `coefficients` or `max_rgb_error`.

    Parameters
    ----------
    sensor : Sensor
        RGB space of the colours.
    grid : Grid
        Arrays of the cube, on the device of JAX.
    threads : int
        Number of threads; each processes a chunk at a time.
    exact : SlowSpectra, optional
        Reflectances of the colours whose nodes have not all their own colours, if there are any.
    """

    sensor: Sensor
    grid: Grid
    threads: int
    exact: SlowSpectra | None = None

    def __repr__(self) -> str:
        return f"Sampler({self.grid.lattice.shape[1]} values per colour, {self.nbytes / 1e6:.1f} MB)"

    def __call__(self, rgb: ArrayLike) -> Floats:
        """Interpolate values (…, N) at linear RGB (…, 3) in [0, 1]; `ColourError` as in `Cube.reflectance`."""
        width = self.grid.lattice.shape[1]
        return blockwise(self._chunk, as_rgb(rgb), width, np.float32, self.threads, CHUNKS[0])

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle arrays of numpy: JAX would restore those of float64 as float32."""
        return _on_device, (self.sensor, Grid(*map(np.asarray, self.grid)), self.threads, self.exact)

    @property
    def nbytes(self) -> int:
        """Memory of the arrays in bytes."""
        return sum(array.nbytes for array in self.grid)

    def _chunk(self, rgb: NDArray[Any]) -> Floats:
        colours = clip_rounding(rgb, self.sensor)
        size = min(size for size in CHUNKS if size >= len(colours))
        missing = size - len(colours)
        padded = np.pad(colours, ((0, missing), (0, 0))) if missing else colours
        with jax.enable_x64(True):
            values = np.asarray(interpolate(self.grid, padded))[: len(colours)]
        require_covered(~np.isnan(values[:, 0]), colours)  # absent points make NaN
        return values if self.exact is None else self.exact.replace(values, colours)


@dataclass(frozen=True, eq=False, repr=False)
class SlowSpectra:
    """Reflectances at wavelengths (N,) in nm by `uplift.lookup.interpolate`, where the kernel is not exact."""

    data: CubeData
    wavelengths: Array

    def replace(self, values: Floats, rgb: Array) -> Floats:
        """Replace the inexact rows of reflectances (n, N) of linear RGB (n, 3)."""
        rows = inexact_rows(self.data, rgb)
        if not rows.size:
            return values
        exact = values.copy()
        exact[rows] = reflectances(self.data, rgb[rows], self.wavelengths)
        return exact


def spectra(cube: Cube, wavelengths: ArrayLike | None = None, *, threads: int = 2) -> Sampler:
    """Prepare a cube for reflectances in mode ``spectra``, accurate to 1e-6.

    The table takes 4 · dim³ · N bytes. A colour reads eight of its rows (32 · N bytes), in an entry box one more.

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

    Raises
    ------
    OptionError
        Invalid wavelengths, or fewer than one thread.
    """
    count = as_thread_count(threads)
    return _sampler(tabulate(cube.data, cube.resolve_wavelengths(wavelengths), np.float32, count), count)


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

    Raises
    ------
    OptionError
        An unsupported count, or fewer than one thread.
    """
    width, threads = as_coefficient_count(count, cube.data), as_thread_count(threads)
    return _sampler(tabulate_coefficients(cube.data, width, np.float32, threads), threads)


def max_rgb_error(cube: Cube, *, threads: int = 2) -> Sampler:
    """Prepare a cube for upper bounds of the colour error, from the fitting distances of the nodes.

    Parameters
    ----------
    cube : Cube
        The cube.
    threads : int, default 2
        Number of threads.

    Returns
    -------
    Sampler
        From linear RGB (..., 3) to the largest ``|linear RGB|`` error (..., 1).

    Raises
    ------
    OptionError
        Fewer than one thread.
    """
    points = cube.data.points
    entries = np.zeros((len(cube.atlas_names), 1), np.float32)
    present = points.distance[points.present, None]
    return _sampler(NodeTable.of_present_points(cube.data, present, entries), as_thread_count(threads))


def _sampler(table: NodeTable, threads: int) -> Sampler:
    exact = None
    if table.wavelengths is not None and table.data.inexact_cells is not None:
        exact = SlowSpectra(table.data, table.wavelengths)
    return _on_device(table.data.sensor, make_grid(table), threads, exact)


def _on_device(sensor: Sensor, grid: Grid, threads: int, exact: SlowSpectra | None) -> Sampler:
    with jax.enable_x64(True):
        return Sampler(sensor, jax.device_put(grid), threads, exact)
