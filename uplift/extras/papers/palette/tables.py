"""Tables of a palette spec: lights and materials by kind, goals, free colours,
differences.
"""

import math
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import (
    AfterValidator,
    BeforeValidator,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    model_validator,
)

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import find_atlas_file, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor, format_rgb, in_unit_cube
from uplift.common.arrays import Array
from uplift.common.errors import ColourError, PaletteError, unknown_name
from uplift.common.text import format_value
from uplift.extras.colour.srgb import MAX_NUMBER, WrittenColour, is_number, parse_colour
from uplift.extras.emission.lamps import find_light, is_illuminant
from uplift.extras.files.spec import (
    InsidePath,
    SpecModel,
    check_inside,
    problem,
    resolves,
)
from uplift.extras.papers.palette.colours import (
    MAX_KELVIN,
    MIN_KELVIN,
    illuminant,
    planck,
)
from uplift.extras.papers.palette.factor import COUNTS
from uplift.extras.papers.palette.palette import Fit, Palette, SpectrumSpec
from uplift.lookup.cube import load

NAME = re.compile(r"[^\W_][\w .+-]*(?<! )")  # names appear in tables, plots and atlases


def _parse_colour(value: Any) -> WrittenColour:
    try:
        return parse_colour(value)
    except ColourError as error:
        raise problem(error.problem, error.hint, error.code) from error


def _check_light(name: str) -> None:
    """Check the name of an illuminant, or else that of a file, which has a suffix."""
    if is_illuminant(name) or not os.path.splitext(name)[1]:
        observer.illuminant_spd(name)
    else:
        check_inside(name)


def _parse_bounds(value: Any) -> tuple[float, float]:
    if value is False:
        return -math.inf, math.inf
    is_pair = isinstance(value, list) and len(value) == 2
    if not is_pair or not all(
        is_number(number) or number in (-math.inf, math.inf) for number in value
    ):
        raise problem(f"must be [low, high] or false, got {format_value(value)}")
    if not value[0] < value[1]:
        raise problem(
            f"must be ascending, got {format_value(value)}", "swap the numbers"
        )
    return float(value[0]), float(value[1])


def _check_name(name: str) -> str:
    if not NAME.fullmatch(name):
        text = (
            "must consist of letters, digits, spaces and .+-_, got "
            f"{format_value(name)}"
        )
        raise problem(text, "begin with a letter or digit, and do not end with a space")
    return name


_NonNegative = Annotated[
    float, Field(strict=True, ge=0, le=MAX_NUMBER, allow_inf_nan=False)
]
_Kelvin = Annotated[
    float, Field(strict=True, ge=MIN_KELVIN, le=MAX_KELVIN, allow_inf_nan=False)
]
_Count = Annotated[
    float, Field(strict=True, ge=COUNTS[0], le=COUNTS[-1], multiple_of=1)
]
_Name = Annotated[str, AfterValidator(_check_name)]
_Colour = Annotated[WrittenColour, PlainValidator(_parse_colour)]
_Bounds = Annotated[tuple[float, float], PlainValidator(_parse_bounds)]


class _KnownLight(SpecModel):
    """A light whose spectrum is known up to its scale: the luminance of white, or the
    norm.

    The norm is the root mean square of the power, the L2 norm of Bergner et al. 2004,
    section 4, for any sampling.
    """

    luminance: _NonNegative | None = None
    norm: _NonNegative | None = None

    @model_validator(mode="after")
    def _scaled_once(self) -> Self:
        if self.luminance is not None and self.norm is not None:
            raise problem(
                "a light has a luminance or a norm, not both", "remove one of them"
            )
        return self

    @property
    def file(self) -> str | None:
        """The file of a lamp."""
        return None

    def power(self, sensor: Sensor, folder: Path) -> Array:
        """Return the power (N,) of luminance 1."""
        raise NotImplementedError

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        """Return the scaled power."""
        power = self.power(sensor, folder)
        if self.norm is not None:
            return SpectrumSpec(name, power * (self.norm / np.sqrt(np.mean(power**2))))
        return SpectrumSpec(
            name, power * (1.0 if self.luminance is None else self.luminance)
        )


class _IlluminantLight(_KnownLight):
    """An illuminant by its name, or a lamp by its file."""

    illuminant: Annotated[str, resolves(_check_light)]

    @property
    def file(self) -> str | None:
        return None if is_illuminant(self.illuminant) else self.illuminant

    def power(self, sensor: Sensor, folder: Path) -> Array:
        return illuminant(
            sensor,
            self.illuminant
            if self.file is None
            else find_light(str(folder / self.file)),
        )


class _BlackBodyLight(_KnownLight):
    planck: _Kelvin

    def power(self, sensor: Sensor, folder: Path) -> Array:
        return planck(sensor, self.planck)


class _DesignedLight(SpecModel):
    design: Literal[True]
    bounds: _Bounds = (0.0, math.inf)

    @property
    def file(self) -> str | None:
        return None

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        return SpectrumSpec(name, None, *self.bounds)


class _AtlasMaterial(SpecModel):
    """A material by its entry in an atlas file."""

    atlas: InsidePath
    entry: str

    @property
    def file(self) -> str | None:
        return self.atlas

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        atlas = read_atlas(find_atlas_file(self.atlas, folder))
        entries = tuple(entry for entry in atlas.entries if entry.name == self.entry)
        if not entries:
            raise unknown_name(self.entry, atlas.names, "entry")
        return SpectrumSpec(name, on_grid(Atlas(entries), sensor.wavelengths)[0])


class _RgbMaterial(SpecModel):
    """A material by its colour, uplifted by a cube."""

    rgb: _Colour
    cube: InsidePath | None = None

    @property
    def file(self) -> str | None:
        return self.cube

    def spectrum(self, name: str, sensor: Sensor, folder: Path) -> SpectrumSpec:
        cube = load(None if self.cube is None else folder / self.cube)
        rgb = self.rgb.rgb(cube.data.sensor)
        if not in_unit_cube(rgb):
            problem = (
                f"rgb of the material '{name}' must be in [0, 1], got {format_rgb(rgb)}"
            )
            raise PaletteError(
                problem,
                hint="write linear RGB from 0 to 1, or '#rrggbb' for 8-bit codes",
            )
        return SpectrumSpec(name, cube.reflectance(rgb, sensor.wavelengths))


class _DesignedMaterial(_DesignedLight):
    bounds: _Bounds = (0.0, 1.0)


class _RgbGoal(SpecModel):
    rgb: _Colour
    weight: _NonNegative = 1.0


class FreeGoal(SpecModel):
    """A free colour, which all goals of its name share."""

    free: _Name
    weight: _NonNegative = 1.0


class FreeRange(SpecModel):
    """Lowest and highest values of a free colour, by default all that a
    display shows.
    """

    low: _Colour = WrittenColour(codes=(0, 0, 0))
    high: _Colour = WrittenColour(codes=(255, 255, 255))


class _Difference(SpecModel):
    """Two materials and their least ΔE00 under a light."""

    materials: Annotated[list[str], Field(min_length=2, max_length=2)]
    light: str
    delta_e: _NonNegative


def _check_kind(*kinds: str) -> BeforeValidator:
    """Return a validator for tables that have exactly one of some keys."""

    def check(value: Any) -> Any:
        if not isinstance(value, dict):
            raise problem(f"must be a table, got {format_value(value)}")
        present = [kind for kind in kinds if kind in value]
        if len(present) != 1:
            text = (
                f"must have exactly one of {', '.join(kinds)}, got "
                f"{', '.join(present) or 'none'}"
            )
            raise problem(text)
        return value

    return BeforeValidator(check)


def _tag(*kinds: str) -> Callable[[Any], str]:
    """Return the tag of the model for the key that is present."""
    return lambda value: next(f"~{kind}" for kind in kinds if kind in value)


def _goal_tag(value: Any) -> str:
    if not isinstance(value, dict):
        return "~colour"
    return "~free" if "free" in value else "~rgb"


_Light = Annotated[
    Annotated[_IlluminantLight, Tag("~illuminant")]
    | Annotated[_BlackBodyLight, Tag("~planck")]
    | Annotated[_DesignedLight, Tag("~design")],
    Discriminator(_tag("illuminant", "planck", "design")),
    _check_kind("illuminant", "planck", "design"),
]
_Material = Annotated[
    Annotated[_AtlasMaterial, Tag("~atlas")]
    | Annotated[_RgbMaterial, Tag("~rgb")]
    | Annotated[_DesignedMaterial, Tag("~design")],
    Discriminator(_tag("atlas", "rgb", "design")),
    _check_kind("atlas", "rgb", "design"),
]
_Goal = Annotated[
    Annotated[_Colour, Tag("~colour")]
    | Annotated[_RgbGoal, Tag("~rgb")]
    | Annotated[FreeGoal, Tag("~free")],
    Discriminator(_goal_tag),
]


class PaletteTable(SpecModel):
    lights: Annotated[dict[_Name, _Light], Field(min_length=1)]
    materials: Annotated[dict[_Name, _Material], Field(min_length=1)]
    colours: dict[str, dict[str, _Goal]] = Field(default_factory=dict)
    free: dict[str, FreeRange] = Field(default_factory=dict)
    apart: list[_Difference] = Field(default_factory=list)
    smoothness: _NonNegative = Palette.smoothness
    model_error: _NonNegative = Palette.model_error
    coefficients: _Count = Palette.count
    fit: Fit = Palette.fit
