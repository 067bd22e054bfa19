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
    header: ClassVar[dict[str, str]] = {}
    """Attributes that the layout requires."""

    @abstractmethod
    def channels(self, cube: Cube) -> tuple[str, ...]:
        """Names of the channels, one per number. Raises `OptionError` if the cube has no such numbers."""

    @abstractmethod
    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        """The function that computes the numbers."""

    def describe(self, cube: Cube) -> dict[str, Any]:
        """The encoding as JSON values: ``as``, its name, and the wavelengths of a spectrum."""
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
    header = SPECTRAL_LAYOUT

    def channels(self, cube: Cube) -> tuple[str, ...]:
        return spectral_channels("T", cube.resolve_wavelengths(self.wavelengths))

    def describe(self, cube: Cube) -> dict[str, Any]:
        return {"as": self.name, "wavelengths": cube.resolve_wavelengths(self.wavelengths).tolist()}

    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        from uplift.lookup import bulk

        return bulk.spectra(cube, self.wavelengths, threads=threads)


@dataclass(frozen=True)
class Moments(PixelEncoding):
    """Coefficients of a moments cube. They are linear in the spectrum, so textures can be filtered and mip-mapped."""

    name = "moments"
    depths = ("float", "half")

    def channels(self, cube: Cube) -> tuple[str, ...]:
        model = cube.data.model
        if not isinstance(model, models.Moments):
            raise OptionError(
                f"moments need a moments cube, got a {model.name} cube",
                code="no-moments",
                hint="write multipliers, or use a moments cube",
            )
        return tuple(f"moment.{index:02}" for index in range(model.count))

    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
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
        return tuple(f"multiplier.{index:02}" for index in range(cube.data.model.count))

    def make_sampler(self, cube: Cube, threads: int) -> Sampler:
        refined = partial(refined_multipliers, cube.data)
        width = cube.data.model.count
        return lambda rgb: blockwise(refined, rgb.astype(float), width, np.float32, threads)


PIXEL_ENCODINGS: dict[str, Callable[[], PixelEncoding]] = {each.name: each for each in (Spectrum, Moments, Multipliers)}
"""Pixel encodings with their defaults, by name."""


def spectral_channels(quantity: str, wavelengths: Array) -> tuple[str, ...]:
    """Name the channels of ascending wavelengths (N,) in nm, such as ``T.550,000000nm``.

    The layout is that of Fichet et al. 2021: the quantity is T, reflectance, or S0, power that is not polarised. Raises
    `OptionError` for wavelengths that do not ascend.
    """
    names = tuple(f"{quantity}." + f"{wavelength:.6f}nm".replace(".", ",") for wavelength in wavelengths)
    if (np.diff(wavelengths) <= 0).any() or len(set(names)) < len(names):
        raise OptionError(
            "wavelengths of a spectral image must ascend in steps of at least 1e-6 nm",
            hint="sort them and remove duplicates",
        )
    return names
