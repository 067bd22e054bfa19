"""Palette spec as a TOML file (docs/palette.md): lights and materials by kind, goals,
free colours, differences.
"""

import math
import os
import re
from collections.abc import Iterator, Mapping
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
    ValidationInfo,
    model_validator,
)

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import find_atlas_file, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor, format_rgb, in_unit_cube
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import PaletteError, unknown_name
from uplift.common.text import format_value
from uplift.extras.colour.srgb import MAX_NUMBER, WrittenColour, parse_colour
from uplift.extras.emission.lamps import find_light, is_illuminant, lamp_file
from uplift.extras.files.spec import (
    FolderPath,
    Key,
    NotNegative,
    Number,
    SpecFolder,
    SpecModel,
    file_in_folder,
    looking_up,
    problem,
    read_spec,
    spec_folder,
)
from uplift.extras.papers.palette.colours import (
    MAX_KELVIN,
    MIN_KELVIN,
    illuminant,
    planck,
)
from uplift.extras.papers.palette.factor import COUNTS
from uplift.extras.papers.palette.palette import (
    ColourGoal,
    Fit,
    MinDifference,
    Palette,
    SpectrumSpec,
)
from uplift.lookup.cube import load

NAME = re.compile(r"[^\W_][\w .+-]*(?<! )")  # names appear in tables, plots and atlases


def read_palette(path: StrPath) -> Palette:
    """Read a palette spec.

    Parameters
    ----------
    path : path-like
        A TOML file. Paths of atlases and cubes start in its folder.

    Returns
    -------
    Palette
        Its lights and materials with their spectra, and its goals.

    Raises
    ------
    PaletteError
        If the file cannot be read or a value does not fit; the error names the key.
    """
    folder = SpecFolder(Path(path).parent)
    table = read_spec(path, PaletteTable, PaletteError, folder=folder)
    sensor = observer.sensor()
    opened = [Path(lamp_file(str(file))) for file in folder.opened]
    return Palette(
        sensor=sensor,
        lights=_spectra(table.lights, sensor),
        materials=_spectra(table.materials, sensor),
        goals=tuple(table.goals(sensor)),
        free=table.free_ranges(sensor),
        min_differences=tuple(table.apart),
        smoothness=table.smoothness,
        model_error=table.model_error,
        count=int(table.coefficients),
        fit=table.fit,
        sources=(Path(path), *opened),
    )


def _spectra(
    specs: Mapping[str, "_Light | _Material"], sensor: Sensor
) -> tuple[SpectrumSpec, ...]:
    return tuple(spec.spectrum(name, sensor) for name, spec in specs.items())


def _check_name(name: str) -> str:
    if not NAME.fullmatch(name):
        text = (
            "must consist of letters, digits, spaces and .+-_, got "
            f"{format_value(name)}"
        )
        raise problem(text, "begin with a letter or digit, and do not end with a space")
    return name


def _parse_colour(value: Any) -> WrittenColour:
    with looking_up():
        return parse_colour(value)


def _check_ascending(bounds: tuple[float, float]) -> tuple[float, float]:
    if not bounds[0] < bounds[1]:
        raise problem(
            f"must be ascending, got {format_value(bounds)}", "swap the numbers"
        )
    return bounds


def _check_light(name: str, info: ValidationInfo) -> str:
    """Check the name of an illuminant, or else return the path of a lamp, which has a
    suffix.
    """
    if is_illuminant(name) or not os.path.splitext(name)[1]:
        with looking_up():
            observer.illuminant_spd(name)
        return name
    return str(file_in_folder(name, info))


def _atlas_file(name: str, info: ValidationInfo) -> StrPath:
    file_in_folder(name, info)
    with looking_up():
        return find_atlas_file(name, spec_folder(info).path)


_Weight = Annotated[NotNegative, Field(le=MAX_NUMBER)]
_Name = Annotated[str, AfterValidator(_check_name)]
_Colour = Annotated[WrittenColour, PlainValidator(_parse_colour)]
_Bound = Annotated[float, Field(strict=True)]
_Bounds = Annotated[
    tuple[_Bound, _Bound],
    BeforeValidator(lambda value: (-math.inf, math.inf) if value is False else value),
    AfterValidator(_check_ascending),
]


class _KnownLight(SpecModel):
    """A light whose spectrum is known up to its scale: the luminance of white, or the
    norm.

    The norm is the root mean square of the power, the L2 norm of Bergner et al. 2004,
    section 4, for any sampling.
    """

    luminance: _Weight | None = None
    norm: _Weight | None = None

    @model_validator(mode="after")
    def _scaled_once(self) -> Self:
        if self.luminance is not None and self.norm is not None:
            raise problem(
                "a light has a luminance or a norm, not both", "remove one of them"
            )
        return self

    def power(self, sensor: Sensor) -> Array:
        """Return the power (N,) of luminance 1."""
        raise NotImplementedError

    def spectrum(self, name: str, sensor: Sensor) -> SpectrumSpec:
        """Return the scaled power."""
        power = self.power(sensor)
        scale = 1.0 if self.luminance is None else self.luminance
        if self.norm is not None:
            scale = self.norm / np.sqrt(np.mean(power**2))
        return SpectrumSpec(name, power * scale)


class _IlluminantLight(_KnownLight):
    """An illuminant by its name, or a lamp by its file."""

    illuminant: Annotated[str, AfterValidator(_check_light)]

    def power(self, sensor: Sensor) -> Array:
        return illuminant(sensor, find_light(self.illuminant))


class _BlackBodyLight(_KnownLight):
    planck: Annotated[Number, Field(ge=MIN_KELVIN, le=MAX_KELVIN)]

    def power(self, sensor: Sensor) -> Array:
        return planck(sensor, self.planck)


class _DesignedLight(SpecModel):
    design: Literal[True]
    bounds: _Bounds = (0.0, math.inf)

    def spectrum(self, name: str, sensor: Sensor) -> SpectrumSpec:
        return SpectrumSpec(name, None, *self.bounds)


class _DesignedMaterial(_DesignedLight):
    bounds: _Bounds = (0.0, 1.0)


class _AtlasMaterial(SpecModel):
    """A material by its entry in an atlas file."""

    atlas: Annotated[StrPath, PlainValidator(_atlas_file)]
    entry: str

    def spectrum(self, name: str, sensor: Sensor) -> SpectrumSpec:
        atlas = read_atlas(self.atlas)
        entries = tuple(entry for entry in atlas.entries if entry.name == self.entry)
        if not entries:
            raise unknown_name(self.entry, atlas.names, "entry")
        return SpectrumSpec(name, on_grid(Atlas(entries), sensor.wavelengths)[0])


class _RgbMaterial(SpecModel):
    """A material by its colour, uplifted by a cube."""

    rgb: _Colour
    cube: FolderPath | None = None

    def spectrum(self, name: str, sensor: Sensor) -> SpectrumSpec:
        cube = load(self.cube)
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


class _Goal(SpecModel):
    """A colour, or the name of a free one, which all goals of its name share."""

    rgb: _Colour | None = None
    free: _Name | None = None
    weight: _Weight = 1.0

    @model_validator(mode="after")
    def _one_colour(self) -> Self:
        if (self.rgb is None) == (self.free is None):
            raise problem("a goal has one of rgb and free", at=("rgb",))
        return self


class FreeRange(SpecModel):
    """Lowest and highest values of a free colour, by default all that a
    display shows.
    """

    low: _Colour = WrittenColour(codes=(0, 0, 0))
    high: _Colour = WrittenColour(codes=(255, 255, 255))

    def rgb(self, sensor: Sensor) -> tuple[Array, Array]:
        """Return lowest and highest linear RGB (3,)."""
        return self.low.rgb(sensor), self.high.rgb(sensor)

    @model_validator(mode="after")
    def _ascending(self) -> Self:
        low, high = self.rgb(observer.sensor())
        if not (low < high).all():
            text = (
                f"must have low < high in every channel, got {low.round(4).tolist()} "
                f"and {high.round(4).tolist()}"
            )
            raise problem(text, "widen the range")
        return self


def _by_kind(*kinds: str) -> Discriminator:
    """Distinguish tables that have exactly one of some keys."""

    def kind(value: Any) -> str | None:
        present = [key for key in kinds if isinstance(value, dict) and key in value]
        return f"~{present[0]}" if len(present) == 1 else None

    text = f"must be a table with exactly one of {', '.join(kinds)}"
    return Discriminator(kind, custom_error_type="kind", custom_error_message=text)


_Light = Annotated[
    Annotated[_IlluminantLight, Tag("~illuminant")]
    | Annotated[_BlackBodyLight, Tag("~planck")]
    | Annotated[_DesignedLight, Tag("~design")],
    _by_kind("illuminant", "planck", "design"),
]
_Material = Annotated[
    Annotated[_AtlasMaterial, Tag("~atlas")]
    | Annotated[_RgbMaterial, Tag("~rgb")]
    | Annotated[_DesignedMaterial, Tag("~design")],
    _by_kind("atlas", "rgb", "design"),
]
_ColourOrGoal = Annotated[
    _Goal,
    BeforeValidator(lambda value: value if isinstance(value, dict) else {"rgb": value}),
]


class PaletteTable(SpecModel):
    lights: Annotated[dict[_Name, _Light], Field(min_length=1)]
    materials: Annotated[dict[_Name, _Material], Field(min_length=1)]
    colours: dict[str, dict[str, _ColourOrGoal]] = Field(default_factory=dict)
    free: dict[str, FreeRange] = Field(default_factory=dict)
    apart: list[MinDifference] = Field(default_factory=list)
    smoothness: _Weight = Palette.smoothness
    model_error: _Weight = Palette.model_error
    coefficients: Annotated[
        Number, Field(ge=COUNTS[0], le=COUNTS[-1], multiple_of=1)
    ] = Palette.count
    fit: Fit = Palette.fit

    @model_validator(mode="after")
    def _known_names(self) -> Self:
        for number, pair in enumerate(self.apart):
            for material in pair.materials:
                self._check_material(material, "apart", number, "materials")
            self._check_light(pair.light, "apart", number, "light")
        for material, goals in self.colours.items():
            self._check_material(material, "colours", material)
            for light in goals:
                self._check_light(light, "colours", material, light)
        return self

    def _check_material(self, name: str, *at: Key) -> None:
        _check_known(name, self.materials, "material", at)

    def _check_light(self, name: str, *at: Key) -> None:
        _check_known(name, self.lights, "light", at)

    def goals(self, sensor: Sensor) -> Iterator[ColourGoal]:
        """Yield the goals with their colours in linear RGB."""
        for material, goals in self.colours.items():
            for light, goal in goals.items():
                rgb = None if goal.rgb is None else goal.rgb.rgb(sensor)
                yield ColourGoal(material, light, rgb, goal.free, goal.weight)

    def free_ranges(self, sensor: Sensor) -> dict[str, tuple[Array, Array]]:
        """Return the range of every free colour."""
        ranges = dict(self.free)
        for goals in self.colours.values():
            for goal in goals.values():
                if goal.free is not None:
                    ranges.setdefault(goal.free, FreeRange())
        return {name: colours.rgb(sensor) for name, colours in ranges.items()}


def _check_known(
    name: str, known: Mapping[str, object], kind: str, at: tuple[Key, ...]
) -> None:
    if name not in known:
        with looking_up(*at):
            raise unknown_name(name, known, kind)
