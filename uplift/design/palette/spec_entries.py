"""Tables of a palette spec: lights and materials by kind, goals, ranges of free colours, and differences."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from uplift import lookup
from uplift.atlas import Atlas, on_grid, read_atlas
from uplift.atlas.shipped import find_atlas_file
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.written_colour import WrittenColour
from uplift.common.arrays import Array
from uplift.common.errors import unknown_name
from uplift.common.spec_file import SpecModel, problem, resolves
from uplift.common.text import format_value
from uplift.design.palette.fields import Bounds, Colour, Name, NonNegative, Number, TrueFlag
from uplift.design.palette.lights import MAX_KELVIN, MIN_KELVIN, illuminant, planck
from uplift.design.palette.palette import SpectrumSpec

BLACK, WHITE = WrittenColour(codes=(0, 0, 0)), WrittenColour(codes=(255, 255, 255))
"""Default range of free colours: all that a display shows."""

Kelvin = Annotated[Number, Field(ge=MIN_KELVIN, le=MAX_KELVIN)]


class KnownLight(SpecModel):
    """A light whose spectrum is known up to its scale.

    ``luminance`` is that of the perfect reflector. ``norm`` is the root mean square of the power over wavelengths, 1
    for a flat power of 1: the L2 norm of Bergner et al. 2004, section 4, for any number of samples.
    """

    luminance: NonNegative | None = None
    norm: NonNegative | None = None

    @model_validator(mode="after")
    def _scaled_once(self) -> Self:
        if self.luminance is not None and self.norm is not None:
            raise problem("scaled-twice", "a light has a luminance or a norm, not both", "remove one of them")
        return self

    def scaled(self, name: str, power: Array) -> SpectrumSpec:
        """Scale a power (N,) of luminance 1."""
        if self.norm is not None:
            return SpectrumSpec(name, power * (self.norm / np.sqrt(np.mean(power**2))))
        return SpectrumSpec(name, power * (1.0 if self.luminance is None else self.luminance))


class IlluminantLight(KnownLight):
    """A light by the name of its illuminant."""

    illuminant: Annotated[str, resolves(observer.illuminant_spd)]

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Spectrum on the wavelengths of the sensor."""
        return self.scaled(name, illuminant(sensor, self.illuminant))


class BlackBodyLight(KnownLight):
    """A black body by its temperature in K."""

    planck: Kelvin

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Spectrum on the wavelengths of the sensor."""
        return self.scaled(name, planck(sensor, self.planck))


class DesignedLight(SpecModel):
    """A light to be designed within bounds of its power."""

    design: TrueFlag
    bounds: Bounds = (0.0, math.inf)

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Open spectrum."""
        return SpectrumSpec(name, None, *self.bounds)


class AtlasMaterial(SpecModel):
    """A material by its entry in an atlas file."""

    atlas: str
    entry: str

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Spectrum on the wavelengths of the sensor. Raises `AtlasError` and `UnknownNameError`."""
        atlas = read_atlas(find_atlas_file(self.atlas, folder))
        entries = tuple(entry for entry in atlas.entries if entry.name == self.entry)
        if not entries:
            raise unknown_name(self.entry, atlas.names, "entry")
        return SpectrumSpec(name, on_grid(Atlas(entries), sensor.wavelengths)[0])


class RgbMaterial(SpecModel):
    """A material by its colour, uplifted by a cube."""

    rgb: Colour
    cube: str | None = None

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Spectrum on the wavelengths of the sensor. Raises `CubeFileError` and `ColourError`."""
        cube = lookup.load(None if self.cube is None else folder / self.cube)
        return SpectrumSpec(name, cube.reflectance(self.rgb.rgb(cube.data.sensor), sensor.wavelengths))


class DesignedMaterial(SpecModel):
    """A material to be designed within bounds of its reflectance."""

    design: TrueFlag
    bounds: Bounds = (0.0, 1.0)

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Open spectrum."""
        return SpectrumSpec(name, None, *self.bounds)


class RgbGoal(SpecModel):
    """A colour to reach."""

    rgb: Colour
    weight: NonNegative = 1.0


class FreeGoal(SpecModel):
    """A free colour, which all goals of its name share."""

    free: Name
    weight: NonNegative = 1.0


class FreeRange(SpecModel):
    """Lowest and highest values of a free colour."""

    low: Colour = BLACK
    high: Colour = WHITE


class Difference(SpecModel):
    """Two materials and their least ΔE00 under a light."""

    materials: Annotated[list[str], Field(min_length=2, max_length=2)]
    light: str
    delta_e: NonNegative


def _check_kind(*kinds: str) -> BeforeValidator:
    """Validator for tables that have exactly one of some keys."""

    def check(value: Any) -> Any:
        if not isinstance(value, dict):
            raise problem("invalid-value", f"must be a table, got {format_value(value)}")
        present = [kind for kind in kinds if kind in value]
        if len(present) != 1:
            text = f"must have exactly one of {', '.join(kinds)}, got {', '.join(present) or 'none'}"
            raise problem("ambiguous-kind", text)
        return value

    return BeforeValidator(check)


def _tag(*kinds: str) -> Callable[[Any], str]:
    """Tag of the model for the key that is present."""
    return lambda value: next(f"~{kind}" for kind in kinds if kind in value)


def _goal_tag(value: Any) -> str:
    return "~colour" if not isinstance(value, dict) else "~free" if "free" in value else "~rgb"


LightTable = Annotated[
    Annotated[IlluminantLight, Tag("~illuminant")]
    | Annotated[BlackBodyLight, Tag("~planck")]
    | Annotated[DesignedLight, Tag("~design")],
    Discriminator(_tag("illuminant", "planck", "design")),
    _check_kind("illuminant", "planck", "design"),
]
MaterialTable = Annotated[
    Annotated[AtlasMaterial, Tag("~atlas")]
    | Annotated[RgbMaterial, Tag("~rgb")]
    | Annotated[DesignedMaterial, Tag("~design")],
    Discriminator(_tag("atlas", "rgb", "design")),
    _check_kind("atlas", "rgb", "design"),
]
Goal = Annotated[
    Annotated[Colour, Tag("~colour")] | Annotated[RgbGoal, Tag("~rgb")] | Annotated[FreeGoal, Tag("~free")],
    Discriminator(_goal_tag),
]
