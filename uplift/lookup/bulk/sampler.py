"""A cube made ready for many colours at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax
import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.colorimetry.gamut import as_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise
from uplift.lookup.bulk.grid import Grid, grid
from uplift.lookup.bulk.kernel import answer
from uplift.lookup.node_table import NodeTable, tabulate
from uplift.lookup.nodes import require
from uplift.lookup.validation import thread_count, within

CHUNKS = (1 << 16, 1 << 12)
"""Rows of a chunk: few shapes, so that little is compiled, and a small one for small questions."""

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Sampler:
    """Numbers of the nodes of a cube, interpolated between them; ``spectra`` and ``coefficients`` make it."""

    sensor: Sensor
    grid: Grid
    threads: int

    def __call__(self, rgb: ArrayLike) -> Floats:
        """(…, N) of linear RGB (…, 3) in [0, 1]. Raises `ColourError` as `Cube.reflectance` does."""
        width = self.grid.lattice.shape[1]
        return blockwise(self._chunk, as_rgb(rgb), width, np.float32, self.threads, CHUNKS[0])

    @property
    def nbytes(self) -> int:
        """Memory that the tables take."""
        return sum(array.nbytes for array in self.grid)

    def _chunk(self, rgb: NDArray[Any]) -> Floats:
        asked = within(rgb, self.sensor)
        size = min(size for size in CHUNKS if size >= len(asked))
        padded = np.pad(asked, ((0, size - len(asked)), (0, 0))) if len(asked) < size else asked
        with jax.enable_x64(True):
            found = np.asarray(answer(self.grid, padded))[: len(asked)]
        require(~np.isnan(found[:, 0]), asked)  # what an absent point has a part in is NaN
        return found


def spectra(cube: Cube, wavelengths: ArrayLike | None = None, *, threads: int = 2) -> Sampler:
    """Reflectance at wavelengths (N,) nm, by default those of the sensor, as `Cube.reflectance` has it.

    Mode ``spectra``, to 1e-6. The table takes 4 · dim³ · N bytes; a colour reads eight rows of it, 32 · N bytes,
    and a ninth within an entry's box. ``threads`` share a question; each takes a chunk of it at a time.
    Raises `OptionError`.
    """
    count = thread_count(threads)
    return _sampler(tabulate(cube.data, cube.wavelengths(wavelengths), np.float32, count), count)


def coefficients(cube: Cube, *, threads: int = 2) -> Sampler:
    """Coefficients (C,) of the cube's model, as `Cube.coefficients` has them, to float32. Raises `OptionError`."""
    data = cube.data
    points, atlas = (
        c.astype(np.float32) for c in (data.points.coefficients[data.points.present], data.atlas.coefficients)
    )
    return _sampler(NodeTable.of_points(data, points, atlas), thread_count(threads))


def max_rgb_error(cube: Cube, *, threads: int = 2) -> Sampler:
    """By how much (1,) answers miss their colours, |linear RGB|, at the most: the fitting distances around."""
    data = cube.data
    entries = np.zeros((len(data.atlas.names), 1), np.float32)
    return _sampler(
        NodeTable.of_points(data, data.points.distance[data.points.present, None], entries),
        thread_count(threads),
    )


def _sampler(table: NodeTable, threads: int) -> Sampler:
    with jax.enable_x64(True):
        return Sampler(table.data.sensor, jax.device_put(grid(table)), threads)
