"""Numbers that a pixel of a texture holds: a reflectance spectrum, moments, or multipliers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

from uplift import models
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.io.texture.colours import Floats
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import refined_multipliers

Sampler = Callable[[Floats], Floats]
"""From linear RGB (…, 3) in [0, 1] to numbers (…, N)."""
SPECTRAL_LAYOUT = {"spectralLayoutVersion": "1.0"}
"""Attribute of files in the layout of Fichet et al. 2021."""


class PixelEncoding(ABC):
    """The numbers of a pixel, the channels for them, and their description in the header."""

    name: ClassVar[str]
    """Name of the encoding."""
    depths: ClassVar[tuple[str, ...]]
    """Channel types that are precise enough, the default first."""
    is_linear: ClassVar[bool] = True
    """Whether the numbers are linear in the spectrum, and so can be filtered and multiplied by alpha."""

    @abstractmethod
    def channels(self, cube: Cube) -> tuple[str, ...]:
        """Return the channel names.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.

        Returns
        -------
        tuple of str
            One name per number.

        Raises
        ------
        OptionError
            The cube has no such numbers.
        """

    @abstractmethod
    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        """Return the function that computes the numbers.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.
        threads : int
            Number of threads.

        Returns
        -------
        callable
            From linear RGB (..., 3), float32 in [0, 1], to numbers (..., N).
        """

    def header(self) -> dict[str, str]:
        """Return the attributes that the layout requires.

        Returns
        -------
        dict
            Attributes by name, none by default.
        """
        return {}

    def describe(self, cube: Cube) -> dict[str, Any]:
        """Return the encoding as JSON values.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.

        Returns
        -------
        dict
            ``as``, the name, and the wavelengths of a spectrum.
        """
        return {"as": self.name}


@dataclass(frozen=True)
class Spectrum(PixelEncoding):
    """Reflectance at wavelengths, a channel ``T.550,000000nm`` each.

    Parameters
    ----------
    wavelengths : tuple of float, optional
        Ascending wavelengths in nm, by default those of the cube's sensor.

    References
    ----------
    A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral Images", JCGT 10(3), 2021.
    """

    wavelengths: tuple[float, ...] | None = None
    name = "spectrum"
    depths = ("half", "float")

    def channels(self, cube: Cube) -> tuple[str, ...]:
        """Return the channel names; see `PixelEncoding`.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.

        Returns
        -------
        tuple of str
            One name per wavelength.

        Raises
        ------
        OptionError
            The wavelengths do not ascend (code ``wavelengths-not-ascending``).
        """
        return spectral_channels("T", cube.resolve_wavelengths(self.wavelengths))

    def header(self) -> dict[str, str]:
        """Return the version of the spectral layout.

        Returns
        -------
        dict
            ``spectralLayoutVersion``.
        """
        return dict(SPECTRAL_LAYOUT)

    def describe(self, cube: Cube) -> dict[str, Any]:
        """Return the name and the wavelengths.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.

        Returns
        -------
        dict
            ``as`` and ``wavelengths``.
        """
        return {"as": self.name, "wavelengths": cube.resolve_wavelengths(self.wavelengths).tolist()}

    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        """Return the function that computes reflectances.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.
        threads : int
            Number of threads.

        Returns
        -------
        callable
            From linear RGB (..., 3) to reflectances (..., N).
        """
        from uplift.lookup import bulk

        return bulk.spectra(cube, self.wavelengths, threads=threads)


@dataclass(frozen=True)
class Moments(PixelEncoding):
    """Coefficients of a moments cube. They are linear in the spectrum, so textures can be filtered and mip-mapped."""

    name = "moments"
    depths = ("float", "half")

    def channels(self, cube: Cube) -> tuple[str, ...]:
        """Return the channel names; see `PixelEncoding`.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.

        Returns
        -------
        tuple of str
            ``moment.00`` onwards.

        Raises
        ------
        OptionError
            The cube stores sigmoids (code ``no-moments``).
        """
        model = cube.data.model
        if not isinstance(model, models.Moments):
            raise OptionError(
                f"moments need a moments cube, got a {model.name} cube",
                code="no-moments",
                hint="write multipliers, or use a moments cube",
            )
        return _numbered("moment", model.count)

    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        """Return the function that computes moments.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.
        threads : int
            Number of threads.

        Returns
        -------
        callable
            From linear RGB (..., 3) to moments (..., C).
        """
        from uplift.lookup import bulk

        return bulk.coefficients(cube, threads=threads)


@dataclass(frozen=True)
class Multipliers(PixelEncoding):
    """Multipliers, from which spectra are evaluated at once. They are refined to the pixel's exact colour.

    Every model has them. They do not interpolate, so textures must not be filtered.
    """

    name = "multipliers"
    depths = ("float",)
    is_linear = False

    def channels(self, cube: Cube) -> tuple[str, ...]:
        """Return the channel names; see `PixelEncoding`.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.

        Returns
        -------
        tuple of str
            ``multiplier.00`` onwards.
        """
        return _numbered("multiplier", cube.data.model.count)

    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        """Return the function that computes multipliers.

        Parameters
        ----------
        cube : Cube
            The cube that uplifts.
        threads : int
            Number of threads.

        Returns
        -------
        callable
            From linear RGB (..., 3) to multipliers (..., C).
        """
        refined = partial(refined_multipliers, cube.data)
        width = cube.data.model.count
        return lambda rgb: blockwise(refined, rgb.astype(float), width, np.float32, threads)


PIXEL_ENCODINGS: dict[str, Callable[[], PixelEncoding]] = {each.name: each for each in (Spectrum, Moments, Multipliers)}
"""Pixel encodings with their defaults, by name."""


def spectral_channels(quantity: str, wavelengths: Array) -> tuple[str, ...]:
    """Name the channels of a spectral image in the layout of Fichet et al. 2021.

    Parameters
    ----------
    quantity : {"T", "S0"}
        Reflectance, or power that is not polarised.
    wavelengths : ndarray, shape (N,)
        Ascending wavelengths in nm.

    Returns
    -------
    tuple of str
        Such as ``T.550,000000nm``.

    Raises
    ------
    OptionError
        The wavelengths do not ascend (code ``wavelengths-not-ascending``).
    """
    names = tuple(f"{quantity}." + f"{wavelength:.6f}nm".replace(".", ",") for wavelength in wavelengths)
    if (np.diff(wavelengths) <= 0).any() or len(set(names)) < len(names):
        raise OptionError(
            "wavelengths of a spectral image must ascend in steps of at least 1e-6 nm",
            code="wavelengths-not-ascending",
            hint="sort them and remove duplicates",
        )
    return names


def _numbered(name: str, count: int) -> tuple[str, ...]:
    return tuple(f"{name}.{index:02}" for index in range(count))
