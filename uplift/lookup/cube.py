"""A cube that answers: linear RGB in, coefficients and reflectance spectra out. numpy alone."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import as_file, files
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.cube import CubeData, read, write
from uplift.errors import ColourError, OptionError, UpliftError
from uplift.lookup.interpolate import BLOCK, MODES, coefficients, standard_error
from uplift.sensor import Array, Sensor


@dataclass(frozen=True, eq=False)
class Cube:
    """A cube ready to be asked; ``data`` is all that its file holds."""

    data: CubeData

    def coefficients(self, rgb: ArrayLike) -> Array:
        """Coefficients (…, C) of the model at linear RGB (…, 3), interpolated between the lattice points.

        Raises `ColourError` for a colour outside [0, 1].
        """
        return self._blockwise(lambda block: coefficients(self.data, block), rgb)

    def reflectance(
        self, rgb: ArrayLike, wavelengths: ArrayLike | None = None, mode: str = "spectra"
    ) -> Array:
        """Reflectance (…, N) in [0, 1] of linear RGB (…, 3), as the cube's space and illuminant have it.

        Parameters
        ----------
        rgb : linear RGB in [0, 1] in the space of the cube.
        wavelengths : (N,) nm; by default those of the cube's sensor. Outside the model's range the
            spectrum is held flat.
        mode : ``spectra`` (exact), ``moments`` (one reconstruction, nearly exact), ``refined`` (exact, ditto).

        Raises
        ------
        ColourError : a colour outside [0, 1] or not finite.
        OptionError : an unknown mode, wavelengths that are not positive numbers.
        """
        if mode not in MODES:
            raise OptionError(f"unknown mode '{mode}'", remedy=f"use one of {', '.join(MODES)}")
        at = self.wavelengths(wavelengths)
        return self._blockwise(lambda block: MODES[mode](self.data, block, at), rgb)

    def standard_error(self, rgb: ArrayLike) -> Array | None:
        """By how much (…,) answers at linear RGB (…, 3) are expected to miss measurements, a root mean square.

        ΔE00 under the light ``cube.data.reference``, learnt from atlas entries left out; None where the cube has
        too few of them. Raises `ColourError`.
        """
        if self.data.standard_error is None:
            return None
        return self._blockwise(lambda block: np.asarray(standard_error(self.data, block))[:, None], rgb)[
            ..., 0
        ]

    def wavelengths(self, wavelengths: ArrayLike | None = None) -> Array:
        """The wavelengths (N,) nm that are asked for; by default those of the sensor. Raises `OptionError`."""
        return self.data.sensor.wavelengths if wavelengths is None else _wavelengths(wavelengths)

    def decode(self, codes: ArrayLike) -> Array:
        """Linear RGB (…) of 8-bit codes (…) as the cube's space encodes them.

        Raises `ColourError` for codes outside 0–255; fractions are interpolated.
        """
        array = _floats(codes, "8-bit codes are numbers")
        if not ((array >= 0) & (array <= 255)).all():
            raise ColourError("8-bit codes run from 0 to 255", remedy="leave out --8bit for linear floats")
        return np.interp(array, np.arange(256), self.data.sensor.decoding)

    def encode(self, rgb: ArrayLike) -> Array:
        """8-bit codes (…), with fractions, of linear RGB (…) in [0, 1]."""
        return np.interp(np.asarray(rgb, dtype=float), self.data.sensor.decoding, np.arange(256))

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the cube file, atomically. Raises `OutputError`."""
        write(self.data, path, force=force)

    def _blockwise(self, function: Callable[[Array], Array], rgb: ArrayLike) -> Array:
        """Apply to (n, 3) blocks of (…, 3), so that memory for the work does not grow with the question."""
        array = _colours(rgb, self.data.sensor)
        flat = array.reshape(-1, 3)
        blocks = [function(flat[i : i + BLOCK]) for i in range(0, max(len(flat), 1), BLOCK)]
        return np.concatenate(blocks).reshape(*array.shape[:-1], blocks[0].shape[-1])


def load(path: str | os.PathLike[str] | None = None) -> Cube:
    """The cube in a file, or the default cube of the package (sRGB, D65, no atlas).

    Raises `CubeFileError` for a file that is no whole cube.
    """
    if path is not None:
        return Cube(read(path))
    with as_file(files("uplift.lookup") / "default.uplift") as default:
        return Cube(read(default))


def _colours(rgb: ArrayLike, sensor: Sensor) -> Array:
    array = _floats(rgb, "a colour is three numbers")
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ColourError(f"a colour is three numbers, not an array of shape {array.shape}")
    outside = ~sensor.holds(array)
    if outside.any():
        first = np.argwhere(outside)[0]
        values = ", ".join(f"{value:g}" for value in array[tuple(first)])
        raise ColourError(
            f"linear RGB ({values}) lies outside [0, 1]",
            remedy="reflectances reach no further; scale or clip it, or use --8bit for codes",
        )
    return np.clip(array, 0, 1)


def _wavelengths(wavelengths: ArrayLike) -> Array:
    problem = "wavelengths must be a list of positive numbers in nm"
    array = np.atleast_1d(_floats(wavelengths, problem, OptionError))
    if array.ndim != 1 or not array.size or not (np.isfinite(array) & (array > 0)).all():
        raise OptionError(problem)
    return array


def _floats(values: Any, problem: str, kind: type[UpliftError] = ColourError) -> Array:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise kind(problem) from error
