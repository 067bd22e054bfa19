"""The emission table: linear RGB of any brightness in, spectral power out. Needs numpy
only.
"""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.colorimetry.sensor import as_rgb
from uplift.common.arrays import Array, Mask, Values, as_array
from uplift.common.errors import ColourError, OptionError
from uplift.extras.emission.chromaticities import (
    chromaticities,
    find_cells,
    is_light,
    polar_coordinates,
    power_of_xyz,
)
from uplift.extras.emission.file import EmissionData, read_emission, write_emission
from uplift.lattice.lattice import weighted_sum
from uplift.lookup.blocks import (
    as_float_type,
    as_thread_count,
    as_wavelengths,
    blockwise,
)
from uplift.lookup.cube import find_file
from uplift.models.arithmetic import blocked_matmul

EMISSION = Path(__file__).with_name("emission.uplift")
"""The packaged table of sRGB."""
OUTSIDE = ("error", "clip")
"""Treatments of colours that no light has: an error, or the nearest colour towards
white.
"""
MAX_VALUE = 1e30
"""Limit of the components of a colour."""


@dataclass(frozen=True, eq=False, repr=False)
class EmissionTable:
    """A table of spectra of lights.

    Powers are relative to the equal-energy light of luminance 1, whose power is 1 at
    every wavelength: XYZ of a power s is Σ s cmfs / Σ ȳ, and white, linear RGB (1, 1,
    1), has luminance 1.

    Parameters
    ----------
    data : EmissionData
        Content of an emission table file.

    Examples
    --------
    >>> import uplift
    >>> table = uplift.load_emission()
    >>> table.spectrum([1.0, 1.0, 1.0], [450, 550, 650]).round(1).tolist()
    [1.2, 1.1, 0.8]
    >>> bool(table.spectrum([1e5, 5e4, 2e4]).min() >= 0)
    True
    """

    data: EmissionData

    def __repr__(self) -> str:
        return f"EmissionTable{repr(self.data).removeprefix('EmissionData')}"

    @property
    def space(self) -> str:
        """RGB space of queries."""
        return self.data.space

    @property
    def observer(self) -> str:
        """Colour-matching functions."""
        return self.data.observer

    @property
    def wavelengths(self) -> Array:
        """(N,) wavelengths of the stored spectra in nm, the default of queries."""
        return self.data.wavelengths

    @property
    def rgb_to_xyz(self) -> Array:
        """(3, 3) matrix from linear RGB to XYZ without adaptation; white has Y = 1."""
        return self.data.rgb_to_xyz

    @property
    def lamp_names(self) -> tuple[str, ...]:
        """Names of the lamps that are exact."""
        return self.data.entries.names

    def spectrum(
        self,
        rgb: ArrayLike,
        wavelengths: ArrayLike | None = None,
        *,
        outside: str = "error",
        dtype: DTypeLike = np.float64,
        threads: int = 1,
    ) -> NDArray[Any]:
        """Compute the spectral power of lights whose colour is the given RGB.

        Power is linear between the stored wavelengths, and constant outside their
        range.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB of any size in the RGB space of the table; negative components
            are allowed.
        wavelengths : array_like, shape (N,), optional
            Wavelengths in nm, by default those of the table.
        outside : {"error", "clip"}, default "error"
            Treatment of colours that no light has: an error, or the nearest colour on
            the way to white of the same luminance. Where luminance is not positive,
            that is black.
        dtype : {float64, float32}, default float64
            Type of the result.
        threads : int, default 1
            Number of threads; the result does not depend on it.

        Returns
        -------
        ndarray, shape (..., N)
            Power, not negative, in units of the equal-energy light of luminance 1.

        Raises
        ------
        ColourError
            Values that are not finite, or a colour that no light has
            (``colour-not-a-light``).
        OptionError
            Invalid wavelengths, treatment, type or number of threads.
        """
        return self.spectrum_of_xyz(
            self.xyz(rgb), wavelengths, outside=outside, dtype=dtype, threads=threads
        )

    def spectrum_of_xyz(
        self,
        xyz: ArrayLike,
        wavelengths: ArrayLike | None = None,
        *,
        outside: str = "error",
        dtype: DTypeLike = np.float64,
        threads: int = 1,
    ) -> NDArray[Any]:
        """Compute the spectral power of lights of the given XYZ, as `spectrum` does.

        Parameters
        ----------
        xyz : array_like, shape (..., 3)
            XYZ; white of the RGB space has Y = 1.
        wavelengths : array_like, shape (N,), optional
            Wavelengths in nm, by default those of the table.
        outside : {"error", "clip"}, default "error"
            Treatment of colours that no light has.
        dtype : {float64, float32}, default float64
            Type of the result.
        threads : int, default 1
            Number of threads.

        Returns
        -------
        ndarray, shape (..., N)
            Power, not negative.

        Raises
        ------
        ColourError
            Values that are not finite, or a colour that no light has
            (``colour-not-a-light``).
        OptionError
            Invalid wavelengths, treatment, type or number of threads.
        """
        if outside not in OUTSIDE:
            raise OptionError(
                f"unknown treatment of colours outside '{outside}'",
                hint=f"use one of {', '.join(OUTSIDE)}",
            )
        at = as_wavelengths(wavelengths, self.wavelengths)
        kind = as_float_type(dtype)
        count = as_thread_count(threads)
        nodes, entries = (
            _resample(spectra, self.wavelengths, at).astype(kind, copy=False)
            for spectra in (
                self.data.spectra.reshape(-1, len(self.wavelengths)),
                self.data.entries.spectra,
            )
        )

        def power(rows: Array) -> NDArray[Any]:
            clip = outside == "clip"
            return power_of_xyz(self.data, nodes, entries, _checked(rows), clip=clip)

        return blockwise(power, as_rgb(xyz), len(at), kind, count)

    def xyz(self, rgb: ArrayLike) -> Array:
        """Convert linear RGB to XYZ.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB.

        Returns
        -------
        ndarray, shape (..., 3)
            XYZ; white has Y = 1.

        Raises
        ------
        ColourError
            Values that are not finite.
        """
        matrix = self.data.rgb_to_xyz.T
        return blockwise(
            lambda rows: blocked_matmul(_checked(rows), matrix), as_rgb(rgb), 3
        )

    def rgb(self, power: ArrayLike) -> Array:
        """Compute the linear RGB of lights, the inverse of `spectrum`.

        Parameters
        ----------
        power : array_like, shape (..., N)
            Power at the wavelengths of the table.

        Returns
        -------
        ndarray, shape (..., 3)
            Linear RGB.
        """
        return self.rgb_of_xyz(as_array(power) @ self.data.radiometry)

    def rgb_of_xyz(self, xyz: ArrayLike) -> Array:
        """Convert XYZ to linear RGB, the inverse of `xyz`.

        Parameters
        ----------
        xyz : array_like, shape (..., 3)
            XYZ; white has Y = 1.

        Returns
        -------
        ndarray, shape (..., 3)
            Linear RGB.
        """
        return as_array(xyz) @ np.linalg.inv(self.data.rgb_to_xyz).T

    def contains(self, rgb: ArrayLike) -> Mask:
        """Test whether a light can have the colours: black, or a chromaticity within
        the spectral locus.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB.

        Returns
        -------
        ndarray of bool, shape (...)

        Raises
        ------
        ColourError
            Values that are not finite.
        """
        xyz = self.xyz(rgb)
        flat = xyz.reshape(-1, 3)
        return is_light(flat, *polar_coordinates(self.data, flat)[1:]).reshape(
            xyz.shape[:-1]
        )

    def expected_error(self, rgb: ArrayLike) -> Array:
        """Estimate how far surfaces lit by an answer are from those lit by a measured
        lamp of the same chromaticity.

        The estimate is learned from lamps that are left out. It does not depend on
        brightness.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB.

        Returns
        -------
        ndarray, shape (...)
            Mean ΔE00 of the ColorChecker.

        Raises
        ------
        ColourError
            Values that are not finite, or a colour that no light has
            (``colour-not-a-light``).
        """

        def errors(xyz: Array) -> Array:
            cells, _ = find_cells(self.data, xyz, *chromaticities(xyz), clip=False)
            corners = self.data.lattice.corners(cells)
            return weighted_sum(
                self.data.error.reshape(-1, 1).astype(float), corners, cells.weights
            )

        return blockwise(errors, self.xyz(rgb), 1)[..., 0]

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the file of the table, atomically.

        Parameters
        ----------
        path : path-like
            File to write.
        force : bool, default False
            Replace an existing file.

        Raises
        ------
        OutputError
            The file exists and ``force`` is false, or cannot be written.
        """
        write_emission(self.data, path, force=force)


def load_emission(path: str | os.PathLike[str] | None = None) -> EmissionTable:
    """Load an emission table.

    Parameters
    ----------
    path : path-like, optional
        File of the table, or ``"emission"`` if no file has the name: the sRGB table of
        the package, also the default.

    Returns
    -------
    EmissionTable
        The table.

    Raises
    ------
    CubeFileError
        The file is missing, damaged, or not an emission table of this version.

    Examples
    --------
    >>> import uplift
    >>> uplift.load_emission().space
    'sRGB'
    """
    return EmissionTable(read_emission(EMISSION if path is None else find_table(path)))


def find_table(path: str | os.PathLike[str]) -> str | os.PathLike[str]:
    """Return the packaged table for its name ``emission``, unless a file has it, or
    else the path.
    """
    return find_file(path, {EMISSION.stem: EMISSION})


def _checked(colours: NDArray[Any]) -> Array:
    """Convert to float64 (n, 3); `ColourError` if a value is not finite or too large to
    be squared.
    """
    array = colours.astype(float, copy=False)
    if not (np.abs(array) <= MAX_VALUE).all():
        raise ColourError(
            f"colours of lights must be finite, and at most {MAX_VALUE:g}"
        )
    return array


def _resample(spectra: Values, grid: Array, wavelengths: Array) -> Values:
    """Interpolate spectra (n, M) on a grid (M,) linearly at wavelengths (N,), constant
    outside the grid.
    """
    if np.array_equal(wavelengths, grid):
        return spectra
    place = np.clip(
        np.interp(wavelengths, grid, np.arange(len(grid))), 0, len(grid) - 1
    )
    low = np.minimum(place.astype(int), len(grid) - 2)
    share = place - low
    return spectra[:, low] * (1 - share) + spectra[:, low + 1] * share
