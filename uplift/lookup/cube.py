"""A cube that answers: linear RGB in, coefficients and reflectance spectra out. numpy alone."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from importlib.resources import as_file, files
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.common.arrays import Array, Mask
from uplift.common.errors import ColourError, OptionError
from uplift.cube import CubeData, read, write
from uplift.lookup.blocks import Function, blockwise
from uplift.lookup.fill import fill_missing, missing_points
from uplift.lookup.interpolate import MODES, coefficients, standard_error
from uplift.lookup.node_table import TABULATED, tabulate
from uplift.lookup.nodes import holds
from uplift.lookup.validation import colours, float_type, floats, thread_count, wavelengths_asked

MOST_BYTES = 1 << 28
"""Largest table of the lattice's spectra that a question is answered from."""


@dataclass(frozen=True, eq=False)
class Cube:
    """A cube ready to be asked; ``data`` is all that its file holds."""

    data: CubeData

    def coefficients(
        self, rgb: ArrayLike, *, dtype: DTypeLike = np.float64, threads: int = 1
    ) -> NDArray[Any]:
        """Coefficients (…, C) of the model at linear RGB (…, 3), interpolated between the lattice points.

        ``dtype``, ``threads`` and what is raised: as for `reflectance`.
        """
        return blockwise(
            partial(coefficients, self.data),
            colours(rgb, self.data.sensor),
            self.data.model.count,
            float_type(dtype),
            thread_count(threads),
        )

    def reflectance(
        self,
        rgb: ArrayLike,
        wavelengths: ArrayLike | None = None,
        mode: str = "spectra",
        *,
        dtype: DTypeLike = np.float64,
        threads: int = 1,
    ) -> NDArray[Any]:
        """Reflectance (…, N) in [0, 1] of linear RGB (…, 3), as the cube's space and illuminant have it.

        Parameters
        ----------
        rgb : linear RGB in [0, 1] in the space of the cube.
        wavelengths : (N,) nm; by default those of the cube's sensor. Outside the model's range the
            spectrum is held flat.
        mode : ``spectra`` (exact), ``moments`` (one reconstruction, nearly exact), ``refined`` (exact, ditto),
            ``nearest`` (the spectrum of the nearest node, whose colour differs).
        dtype : of the answer: float64 or float32, which takes half the room and differs by less than 1e-6.
        threads : how many share a question of thousands of colours; the answer is the same.

        Raises
        ------
        ColourError : a colour outside [0, 1] or not finite.
        OptionError : an unknown mode, wavelengths that are not positive numbers, another dtype, no threads.
        """
        if mode not in MODES:
            raise OptionError(f"unknown mode '{mode}'", hint=f"use one of {', '.join(MODES)}")
        at, kind, count = self.wavelengths(wavelengths), float_type(dtype), thread_count(threads)
        asked = colours(rgb, self.data.sensor)
        function: Function
        if mode in TABULATED and self._tabulates(asked.size // 3, len(at) * kind.itemsize):
            function = partial(TABULATED[mode], tabulate(self.data, at, kind, count))
        else:
            function = partial(_reflectance, self.data, mode, at)
        return blockwise(function, asked, len(at), kind, count)

    def _tabulates(self, colours: int, bytes_each: int) -> bool:
        """Whether to work out the spectra of all lattice points first, so that no block does so again."""
        table = self.data.lattice.size * bytes_each
        return table <= MOST_BYTES and colours >= int(self.data.points.present.sum())

    def holds(self, rgb: ArrayLike) -> Mask:
        """Whether (…,) linear RGB (…, 3) can be asked: always, but for cubes of a scene. Raises `ColourError`."""
        asked = colours(rgb, self.data.sensor)
        return holds(self.data, asked.reshape(-1, 3)).reshape(asked.shape[:-1])

    def fill_missing(
        self, rgb: ArrayLike | None = None, other: Cube | None = None, *, threads: int = 1
    ) -> Cube:
        """A cube of a scene with what linear RGB (…, 3), by default all colours, lack, from another cube.

        ``other``, by default the package's own, gives its spectra at the absent lattice points, in this cube's
        model and exact in colour. Raises `ColourError`, also where the cubes are not of the same RGB.
        """
        asked = None if rgb is None else colours(rgb, self.data.sensor).reshape(-1, 3)
        points = missing_points(self.data, asked)
        if not points.size:
            return self
        return Cube(
            fill_missing(self.data, points, (load() if other is None else other).data, thread_count(threads))
        )

    def standard_error(self, rgb: ArrayLike) -> Array | None:
        """By how much (…,) answers at linear RGB (…, 3) are expected to miss measurements, a root mean square.

        ΔE00 under the light ``cube.data.error_illuminant``, learnt from atlas entries left out; None where the cube has
        too few of them. Raises `ColourError`.
        """
        if self.data.points.standard_error is None:
            return None
        return blockwise(partial(standard_error, self.data), colours(rgb, self.data.sensor), 1)[..., 0]

    def wavelengths(self, wavelengths: ArrayLike | None = None) -> Array:
        """The wavelengths (N,) nm that are asked for; by default those of the sensor. Raises `OptionError`."""
        return self.data.sensor.wavelengths if wavelengths is None else wavelengths_asked(wavelengths)

    def decode(self, codes: ArrayLike) -> Array:
        """Linear RGB (…) of 8-bit codes (…) as the cube's space encodes them.

        Raises `ColourError` for codes outside 0–255; fractions are interpolated.
        """
        array = floats(codes, "8-bit codes are numbers")
        if not ((array >= 0) & (array <= 255)).all():
            raise ColourError("8-bit codes run from 0 to 255", hint="leave out --8bit for linear floats")
        return self.data.sensor.decode(array)

    def encode(self, rgb: ArrayLike) -> Array:
        """8-bit codes (…), with fractions, of linear RGB (…) in [0, 1]."""
        return np.interp(np.asarray(rgb, dtype=float), self.data.sensor.decoding, np.arange(256))

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the cube file, atomically. Raises `OutputError`."""
        write(self.data, path, force=force)


def load(path: str | os.PathLike[str] | None = None) -> Cube:
    """The cube in a file, or the default cube of the package (sRGB, D65, no atlas).

    Raises `CubeFileError` for a file that is no whole cube.
    """
    if path is not None:
        return Cube(read(path))
    with as_file(files("uplift.lookup") / "default.uplift") as default:
        return Cube(read(default))


def _reflectance(data: CubeData, mode: str, wavelengths: Array, rgb: Array) -> Array:
    return MODES[mode](data, rgb, wavelengths)
