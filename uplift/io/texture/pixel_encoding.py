"""What a texture can hold in place of a colour: a spectrum, its moments, or its multipliers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import numpy as np

from uplift import models
from uplift.common.errors import OptionError
from uplift.io.texture.colours import Floats
from uplift.lookup import Cube, bulk
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import refined_multipliers

Sample = Callable[[Floats], Floats]
"""From linear RGB (…, 3) in [0, 1] to numbers (…, N)."""


class PixelEncoding(Protocol):
    """Numbers per pixel, channels that hold them, and what the header says of them."""

    @property
    def name(self) -> str: ...

    @property
    def depths(self) -> tuple[str, ...]:
        """Types that the numbers may be written in, the default first."""
        ...

    def channels(self, cube: Cube) -> tuple[str, ...]:
        """A name for each number. Raises `OptionError` where the cube has no such numbers."""
        ...

    def header(self) -> dict[str, str]:
        """Attributes that the form asks for."""
        ...

    def describe(self, cube: Cube) -> dict[str, Any]:
        """What the form is, as JSON values."""
        ...

    def sample(self, cube: Cube, threads: int) -> Sample: ...


@dataclass(frozen=True)
class Spectrum:
    """Reflectance at wavelengths (nm), by default the cube's: the layout of Fichet, Pacanowski & Wilkie 2021.

    "An OpenEXR Layout for Spectral Images", JCGT 10(3): a channel ``T.550,000000nm`` per wavelength.
    """

    wavelengths: tuple[float, ...] | None = None
    name = "spectrum"
    depths = ("half", "float")

    def channels(self, cube: Cube) -> tuple[str, ...]:
        at = cube.wavelengths(self.wavelengths)
        names = tuple("T." + f"{wavelength:.6f}nm".replace(".", ",") for wavelength in at)
        if (np.diff(at) <= 0).any() or len(set(names)) < len(names):
            raise OptionError("wavelengths of a spectral image ascend", hint="name each once, in order")
        return names

    def header(self) -> dict[str, str]:
        return {"spectralLayoutVersion": "1.0"}

    def describe(self, cube: Cube) -> dict[str, Any]:
        return {"as": self.name, "wavelengths": cube.wavelengths(self.wavelengths).tolist()}

    def sample(self, cube: Cube, threads: int) -> Sample:
        return bulk.spectra(cube, self.wavelengths, threads=threads)


@dataclass(frozen=True)
class Moments:
    """What a moments cube stores: linear in the spectrum, so that textures may be filtered and mip-mapped."""

    name = "moments"
    depths = ("float", "half")

    def channels(self, cube: Cube) -> tuple[str, ...]:
        model = cube.data.model
        if not isinstance(model, models.Moments):
            raise OptionError(
                f"a {model.name} cube has no moments", hint="use --as multipliers, or a moments cube"
            )
        return _numbered("moment", model.count)

    def header(self) -> dict[str, str]:
        return {}

    def describe(self, cube: Cube) -> dict[str, Any]:
        return {"as": self.name}

    def sample(self, cube: Cube, threads: int) -> Sample:
        return bulk.coefficients(cube, threads=threads)


@dataclass(frozen=True)
class Multipliers:
    """What a spectrum is evaluated from, of every model; moved to the very colour, for they do not interpolate."""

    name = "multipliers"
    depths = ("float",)

    def channels(self, cube: Cube) -> tuple[str, ...]:
        return _numbered("multiplier", cube.data.model.count)

    def header(self) -> dict[str, str]:
        return {}

    def describe(self, cube: Cube) -> dict[str, Any]:
        return {"as": self.name}

    def sample(self, cube: Cube, threads: int) -> Sample:
        refined = partial(refined_multipliers, cube.data)
        width = cube.data.model.count
        return lambda rgb: blockwise(refined, rgb.astype(float), width, np.float32, threads)


FORMS: dict[str, Callable[[], PixelEncoding]] = {form.name: form for form in (Spectrum, Moments, Multipliers)}
"""By name, with their defaults."""


def _numbered(what: str, count: int) -> tuple[str, ...]:
    return tuple(f"{what}.{index:02}" for index in range(count))
