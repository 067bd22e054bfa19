"""The emission table: linear RGB of any brightness in, spectral power out. Needs numpy only."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.colorimetry.gamut import as_rgb
from uplift.common.arrays import Array, Indices, Mask, Values
from uplift.common.errors import ColourError, OptionError
from uplift.cube import EmissionData, is_emission_table, read_emission, write_emission
from uplift.lattice.chromaticity import DENOMINATOR, SLACK
from uplift.lookup.blocks import blockwise
from uplift.lookup.validation import as_float_type, as_thread_count, as_wavelengths

DEFAULT_EMISSION = Path(__file__).with_name("emission.uplift")
"""The emission table that comes with the package."""
PACKAGED_NAME = "emission"
"""Name of that table on the command line."""
MAX_VALUE = 1e30
"""Limit of the components of a colour."""


@dataclass(frozen=True, eq=False, repr=False)
class EmissionTable:
    """A table of spectra of lights.

    Powers are relative to the equal-energy light of luminance 1, whose power is 1 at every wavelength: XYZ of a power s
    is Σ s cmfs / Σ ȳ, and white, linear RGB (1, 1, 1), has luminance 1.

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

    @cached_property
    def _radiometry(self) -> Array:
        """(N, 3) from power to XYZ."""
        return np.asarray(self.data.cmfs / self.data.cmfs[:, 1].sum())

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

        Power is linear between the stored wavelengths, and constant outside their range.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB of any size in the RGB space of the table; negative components are allowed.
        wavelengths : array_like, shape (N,), optional
            Wavelengths in nm, by default those of the table.
        outside : {"error", "clip"}, default "error"
            Treatment of colours that no light has: an error, or the nearest colour on the way to white of the same
            luminance. Where luminance is not positive, that is black.
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
            Values that are not finite, or a colour that no light has (``colour-not-a-light``).
        OptionError
            Invalid wavelengths, treatment, type or number of threads.
        """
        return self.spectrum_of_xyz(self.xyz(rgb), wavelengths, outside=outside, dtype=dtype, threads=threads)

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
            Values that are not finite, or a colour that no light has (``colour-not-a-light``).
        OptionError
            Invalid wavelengths, treatment, type or number of threads.
        """
        if outside not in TREATMENTS:
            raise OptionError(
                f"unknown treatment of colours outside '{outside}'",
                code="unknown-treatment",
                hint=f"use one of {', '.join(TREATMENTS)}",
            )
        at = self.wavelengths if wavelengths is None else as_wavelengths(wavelengths)
        kind, count = as_float_type(dtype), as_thread_count(threads)
        find = partial(_find_lights, self.data, TREATMENTS[outside])
        query = partial(_spectra, self.data, _resample(self.data, at), find, kind)
        return blockwise(query, _as_floats(xyz), len(at), kind, count)

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
        return _as_floats(rgb) @ self.data.rgb_to_xyz.T

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
        return self.rgb_of_xyz(np.asarray(power, dtype=float) @ self._radiometry)

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
        return np.asarray(np.asarray(xyz, dtype=float) @ np.linalg.inv(self.data.rgb_to_xyz).T)

    def contains(self, rgb: ArrayLike) -> Mask:
        """Test whether a light can have the colours: black, or a chromaticity within the spectral locus.

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
        return is_light(self.data, xyz.reshape(-1, 3)).reshape(xyz.shape[:-1])

    def expected_error(self, rgb: ArrayLike) -> Array:
        """Estimate how far surfaces lit by an answer are from those lit by a measured lamp of the same chromaticity.

        The estimate is learned from lamps that are left out. It does not depend on brightness.

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
            Values that are not finite, or a colour that no light has (``colour-not-a-light``).
        """
        return blockwise(partial(_errors, self.data), self.xyz(rgb), 1)[..., 0]

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
        File of the table, or ``emission`` if no file has this name. By default the table of the package, for linear
        sRGB.

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
    return EmissionTable(read_emission(DEFAULT_EMISSION if path is None else find_emission_file(path)))


def find_emission_file(path: str | os.PathLike[str]) -> str | os.PathLike[str]:
    """Return the file that a path, or the name of the packaged table, stands for.

    Parameters
    ----------
    path : path-like
        A file, which takes precedence, or the name ``emission``, in any case.

    Returns
    -------
    path-like
        The file; it may be missing.
    """
    name = os.fspath(path)
    return DEFAULT_EMISSION if name.casefold() == PACKAGED_NAME and not os.path.lexists(name) else path


def names_emission_table(path: str | os.PathLike[str]) -> bool:
    """Whether a path, or the name of the packaged table, stands for an emission table.

    Parameters
    ----------
    path : path-like
        As of `find_emission_file`.

    Returns
    -------
    bool
        False for other files, and for those that cannot be read.
    """
    return is_emission_table(find_emission_file(path))


def _as_floats(colours: ArrayLike) -> Array:
    """Convert to float64 (…, 3); `ColourError` if a value is not finite or too large to be squared."""
    array = np.asarray(as_rgb(colours), dtype=float)
    if not (np.abs(array) <= MAX_VALUE).all():
        raise ColourError(
            f"colours of lights must be finite, and at most {MAX_VALUE:g}", code="rgb-not-finite"
        )
    return array


def is_light(data: EmissionData, xyz: Array) -> Mask:
    """Test whether (n,) XYZ (n, 3) are black or within the spectral locus.

    Parameters
    ----------
    data : EmissionData
        The table.
    xyz : ndarray, shape (n, 3)
        XYZ.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    offset, size = _homogeneous(data, xyz)
    _, _, share = data.lattice.polar(offset)
    return np.asarray(((size > 0) & (share <= size * (1 + SLACK))) | (xyz == 0).all(axis=1))


@dataclass(frozen=True, eq=False)
class _Samples:
    """Spectra at the wavelengths of a query."""

    nodes: Values
    """(K · R, N)"""
    entries: Array
    """(E, N)"""


def _resample(data: EmissionData, wavelengths: Array) -> _Samples:
    """Interpolate all spectra linearly, with constant extrapolation."""
    nodes = data.spectra.reshape(-1, data.spectra.shape[-1])
    if np.array_equal(wavelengths, data.wavelengths):
        return _Samples(nodes, data.entries.spectra)
    grid = data.wavelengths
    place = np.clip(np.interp(wavelengths, grid, np.arange(len(grid))), 0, len(grid) - 1)
    low = np.minimum(place.astype(int), len(grid) - 2)
    share = place - low

    def at(spectra: Values) -> Array:
        return np.asarray(spectra[:, low] * (1 - share) + spectra[:, low + 1] * share)

    return _Samples(at(nodes), at(data.entries.spectra))


def _homogeneous(data: EmissionData, xyz: Array) -> tuple[Array, Array]:
    """u′v′ from white (n, 2), times X + 15 Y + 3 Z, and X + 15 Y + 3 Z (n,)."""
    size = xyz @ DENOMINATOR
    return xyz[:, :2] * (4.0, 9.0) - size[:, None] * data.lattice.white, size


@dataclass(frozen=True, eq=False)
class _Lights:
    """Colours of lights: u′v′ (n, 2), X + 15 Y + 3 Z (n,), and what `ChromaticityLattice.polar` returns of u′v′."""

    uv: Array
    size: Array
    sector: Indices
    along: Array
    share: Array


Treatment = Callable[[EmissionData, Array, Array, Array, Array], None]
"""What is done, in place, with XYZ (n, 3) that no light has: their offsets (n, 2) from white, sizes and shares (n,)."""


def _refuse(data: EmissionData, xyz: Array, offset: Array, size: Array, share: Array) -> None:
    """Raise `ColourError` unless all excesses are rounding."""
    wrong = (size <= 0) & (xyz != 0).any(axis=1) | (share > size * (1 + SLACK))
    if wrong.any():
        first = ", ".join(f"{value:.4g}" for value in xyz[wrong][0])
        raise ColourError(
            f"no light has the colour XYZ ({first})",
            code="colour-not-a-light",
            hint="use outside='clip' for the nearest colour towards white",
        )
    _clip(data, xyz, offset, size, share)


def _clip(data: EmissionData, xyz: Array, offset: Array, size: Array, share: Array) -> None:
    """Move colours towards white of the same luminance, white + f (colour − white), up to a share of 1."""
    white = np.maximum(xyz[:, 1], 0.0) * 9 / data.lattice.white[1]
    reach = share + white - size
    step = np.divide(white, reach, out=np.zeros_like(reach), where=reach > 0)
    offset *= step[:, None]
    share *= step
    size[:] = share


TREATMENTS: dict[str, Treatment] = {"error": _refuse, "clip": _clip}
"""Treatments of colours that no light has, by name: an error, or the nearest colour towards white."""


def _find_lights(data: EmissionData, treat: Treatment, xyz: Array) -> _Lights:
    offset, size = _homogeneous(data, xyz)
    sector, along, share = data.lattice.polar(offset)
    rows = np.flatnonzero((size <= 0) | (share > size))
    if rows.size:
        moved = offset[rows], size[rows], share[rows]
        treat(data, xyz[rows], *moved)
        offset[rows], size[rows], share[rows] = moved
    positive = size > 0
    uv = np.divide(offset, size[:, None], out=np.zeros_like(offset), where=positive[:, None])
    share = np.divide(share, size, out=np.zeros_like(share), where=positive)
    return _Lights(data.lattice.white + uv, size, sector, along, share)


def _spectra(
    data: EmissionData, samples: _Samples, find: Callable[[Array], _Lights], kind: DTypeLike, xyz: Array
) -> NDArray[Any]:
    """Power (n, N) of colours (n, 3), computed in a type."""
    lights = find(xyz)
    discs = data.entries.locate(lights.uv)
    if discs.rows.size:
        moved = data.lattice.polar(discs.exit_uv - data.lattice.white)
        for values, changed in zip((lights.sector, lights.along, lights.share), moved, strict=True):
            values[discs.rows] = changed
    power = _mix(data, samples.nodes, lights, kind)
    share = discs.share[:, None].astype(power.dtype)
    power[discs.rows] = (1 - share) * power[discs.rows] + share * samples.entries[discs.entry]
    power *= lights.size[:, None].astype(power.dtype)
    return power


def _errors(data: EmissionData, xyz: Array) -> NDArray[Any]:
    return _mix(data, data.error.reshape(-1, 1), _find_lights(data, _refuse, xyz), float)


def _mix(data: EmissionData, values: Values, lights: _Lights, kind: DTypeLike) -> NDArray[Any]:
    """Weighted sums (n, M) of the values of the nodes (K · R, M), computed in a type."""
    cells = data.lattice.cells(lights.sector, lights.along, lights.share)
    knots, rings = data.lattice.shape
    first, second = cells.sector * rings + cells.ring, (cells.sector + 1) % knots * rings + cells.ring
    weights = cells.weights.astype(kind)
    total = weights[:, :1] * values[first]
    for corner, weight in zip((first + 1, second, second + 1), weights.T[1:], strict=True):
        total += weight[:, None] * values[corner]
    return np.asarray(total)
