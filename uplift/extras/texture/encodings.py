"""The numbers of a pixel of a texture: spectra, moments or multipliers of a cube."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar

import numpy as np

from uplift import models
from uplift.common.arrays import Array, Floats, Indices
from uplift.common.errors import OptionError
from uplift.extras.images.converter import Band
from uplift.lookup.blocks import as_wavelengths, blockwise
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import extended_multipliers, refined_multipliers
from uplift.models.model import Model

Sampler = Callable[[Floats], Floats]
"""From linear RGB (…, 3) in [0, 1] to numbers (…, N)."""
SPECTRAL_LAYOUT = {"spectralLayoutVersion": "1.0"}
"""Attribute of files in the layout of Fichet et al. 2021."""


@dataclass(frozen=True, eq=False)
class Pixels:
    """Numbers of a pixel encoding of a cube.

    ``channels`` (N,) are named, and described by ``details`` as JSON values. ``sample``
    maps linear RGB (…, 3) in [0, 1] to numbers (…, N): the multipliers of ``model``,
    or linear in the spectrum without one. ``outside`` (O, N) are those of the entries
    outside the RGB space, if there are any.
    """

    channels: tuple[str, ...]
    sample: Sampler
    outside: Floats | None
    model: Model | None = None
    details: Mapping[str, Any] = field(default_factory=dict)

    def weighted(self, numbers: Floats, band: Band) -> Floats:
        """Multiply numbers by the alpha of a band, if they are linear."""
        return numbers if self.model is not None else band.weighted(numbers)


class PixelEncoding(ABC):
    """The numbers of a pixel, the channels for them, and their description in the
    header.
    """

    name: ClassVar[str]
    """Name of the encoding."""
    depths: ClassVar[tuple[str, ...]]
    """Channel types that are precise enough, the default first."""
    header: ClassVar[dict[str, str]] = {}
    """Attributes that the layout requires."""

    @abstractmethod
    def pixels(self, cube: Cube, threads: int) -> Pixels:
        """The numbers for a cube. Raises `OptionError` if it has none of this kind."""


@dataclass(frozen=True)
class Spectrum(PixelEncoding):
    """Reflectance at wavelengths, a channel ``T.550,000000nm`` each.

    Parameters
    ----------
    wavelengths : tuple of float, optional
        Ascending wavelengths in nm, by default those of the cube's sensor.

    References
    ----------
    A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral Images", JCGT
    10(3), 2021.
    """

    wavelengths: tuple[float, ...] | None = None
    name = "spectrum"
    depths = ("half", "float")
    header = SPECTRAL_LAYOUT

    def pixels(self, cube: Cube, threads: int) -> Pixels:
        from uplift.lookup import bulk

        at = as_wavelengths(self.wavelengths, cube.wavelengths)
        entries = cube.data.atlas.outside
        channels = spectral_channels("T", at)
        outside = None
        if entries is not None:
            rows = np.arange(len(entries.names))
            outside = entries.spectra.reflectance(rows, at).astype(np.float32)
        sample = bulk.spectra(cube, self.wavelengths, threads=threads)
        return Pixels(channels, sample, outside, details={"wavelengths": at.tolist()})


@dataclass(frozen=True)
class Moments(PixelEncoding):
    """Coefficients of a moments cube. They are linear in the spectrum, so textures can
    be filtered and mip-mapped.
    """

    name = "moments"
    depths = ("float", "half")

    def pixels(self, cube: Cube, threads: int) -> Pixels:
        from uplift.lookup import bulk

        model = cube.data.model
        entries = cube.data.atlas.outside
        if not isinstance(model, models.Moments):
            raise OptionError(
                f"moments need a moments cube, got a {model.name} cube",
                hint="write multipliers",
            )
        outside = None if entries is None else entries.coefficients.astype(np.float32)
        channels = tuple(f"moment.{index:02}" for index in range(model.count))
        return Pixels(channels, bulk.coefficients(cube, threads=threads), outside)


@dataclass(frozen=True)
class Multipliers(PixelEncoding):
    """Multipliers, from which spectra are evaluated at once. They are refined to the
    pixel's exact colour.

    Every model has them. They do not interpolate, so textures must not be filtered.

    Parameters
    ----------
    of_entries : bool
        As many as the spectra of entries have, instead of those of nodes.
    """

    of_entries: bool = False
    name = "multipliers"
    depths = ("float",)

    def pixels(self, cube: Cube, threads: int) -> Pixels:
        data = cube.data
        entries = cube.data.atlas.outside
        function = partial(refined_multipliers, data)
        model = data.model
        outside = None
        if self.of_entries:
            function = partial(extended_multipliers, data)
            model = data.atlas.spectra.model
        if entries is not None:
            numbers = (
                entries.spectra.multipliers
                if self.of_entries
                else data.model.from_storage(entries.coefficients)
            )
            outside = numbers.astype(np.float32)

        def sample(rgb: Floats) -> Floats:
            # images have few: a colour takes long, and has the same answer each time
            colours, rows = different_colours(rgb)
            floats = colours.astype(float)
            return blockwise(function, floats, model.count, np.float32, threads)[rows]

        channels = tuple(f"multiplier.{index:02}" for index in range(model.count))
        return Pixels(channels, sample, outside, model)


PIXEL_ENCODINGS: dict[str, Callable[[], PixelEncoding]] = {
    Spectrum.name: Spectrum,
    Moments.name: Moments,
    Multipliers.name: Multipliers,
}
"""Pixel encodings with their defaults, by name."""


def different_colours(rgb: Floats) -> tuple[Floats, Indices]:
    """Return the different colours (n, 3) of an image (…, 3), and the row (…) of each
    pixel among them.
    """
    flat = np.ascontiguousarray(rgb, dtype=np.float32).reshape(-1, 3)
    red, green, blue = flat.view(np.uint32).astype(np.uint64).T
    keys = (red << 32 | green) * np.uint64(0x9E3779B97F4A7C15) ^ blue
    _, first, rows = np.unique(keys, return_index=True, return_inverse=True)
    if (flat[first][rows] != flat).any():  # two colours have one key
        return flat, np.arange(len(flat)).reshape(rgb.shape[:-1])
    return flat[first], rows.reshape(rgb.shape[:-1])


def spectral_channels(quantity: str, wavelengths: Array) -> tuple[str, ...]:
    """Name the channels of ascending wavelengths (N,) in nm, such as
    ``T.550,000000nm``.

    The layout is that of Fichet et al. 2021: the quantity is T, reflectance, or S0,
    power that is not polarised. Raises `OptionError` for wavelengths that do not
    ascend.
    """
    names = tuple(
        f"{quantity}." + f"{wavelength:.6f}nm".replace(".", ",")
        for wavelength in wavelengths
    )
    if (np.diff(wavelengths) <= 0).any() or len(set(names)) < len(names):
        raise OptionError(
            "wavelengths of a spectral image must ascend in steps of at least 1e-6 nm",
            hint="sort them and remove duplicates",
        )
    return names
