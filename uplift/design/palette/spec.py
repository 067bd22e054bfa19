"""Palette spec as a TOML file (docs/palette.md)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated

from pydantic import Field

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.written_colour import WrittenColour
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import PaletteError, unknown_name
from uplift.common.spec_file import Key, SpecFile, SpecModel, read_toml
from uplift.design.palette.factor import COUNTS
from uplift.design.palette.fields import Name, NonNegative
from uplift.design.palette.palette import ColourGoal, Fit, MinDifference, Palette
from uplift.design.palette.spec_entries import (
    AtlasMaterial,
    Difference,
    FreeGoal,
    FreeRange,
    Goal,
    LightTable,
    MaterialTable,
    RgbMaterial,
)

Count = Annotated[float, Field(strict=True, ge=COUNTS[0], le=COUNTS[-1], multiple_of=1)]


class _PaletteTable(SpecModel):
    """The keys of a spec."""

    lights: Annotated[dict[Name, LightTable], Field(min_length=1)]
    materials: Annotated[dict[Name, MaterialTable], Field(min_length=1)]
    colours: dict[str, dict[str, Goal]] = Field(default_factory=dict)
    free: dict[str, FreeRange] = Field(default_factory=dict)
    apart: list[Difference] = Field(default_factory=list)
    smoothness: NonNegative = Palette.smoothness
    model_error: NonNegative = Palette.model_error
    coefficients: Count = Palette.count
    fit: Fit = Palette.fit


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
        If the file cannot be read or a value does not fit, with the line and the key.
    AtlasError, CubeFileError, ColourError, UnknownNameError
        If an atlas or a cube cannot be read, or lacks an entry or a colour.
    """
    file = read_toml(path, PaletteError)
    table = file.validate(_PaletteTable)
    sensor, folder = observer.sensor(), file.path.parent
    for number, difference in enumerate(table.apart):
        for material in difference.materials:
            _check_known(file, ("apart", number, "materials"), material, table.materials, "material")
        _check_known(file, ("apart", number, "light"), difference.light, table.lights, "light")
    goals = tuple(_goals(file, table, sensor))
    free = dict(table.free)
    for goal in goals:
        if goal.free is not None:
            free.setdefault(goal.free, FreeRange())
    return Palette(
        sensor=sensor,
        lights=tuple(light.spectrum(name, sensor, folder) for name, light in table.lights.items()),
        materials=tuple(each.spectrum(name, sensor, folder) for name, each in table.materials.items()),
        goals=goals,
        free={name: _free_range(file, name, colours, sensor) for name, colours in free.items()},
        min_differences=tuple(
            MinDifference((each.materials[0], each.materials[1]), each.light, each.delta_e) for each in table.apart
        ),
        smoothness=table.smoothness,
        model_error=table.model_error,
        count=int(table.coefficients),
        fit=table.fit,
        sources=(file.path, *(folder / name for name in _files(table))),
    )


def _files(table: _PaletteTable) -> Iterator[str]:
    """Names of the atlases and cubes in a spec."""
    for material in table.materials.values():
        if isinstance(material, AtlasMaterial):
            yield material.atlas
        elif isinstance(material, RgbMaterial) and material.cube is not None:
            yield material.cube


def _goals(file: SpecFile, table: _PaletteTable, sensor: Sensor) -> Iterator[ColourGoal]:
    for material, goals in table.colours.items():
        _check_known(file, ("colours", material), material, table.materials, "material")
        for light, goal in goals.items():
            _check_known(file, ("colours", material, light), light, table.lights, "light")
            if isinstance(goal, WrittenColour):
                yield ColourGoal(material, light, rgb=goal.rgb(sensor))
            elif isinstance(goal, FreeGoal):
                yield ColourGoal(material, light, free=goal.free, weight=goal.weight)
            else:
                yield ColourGoal(material, light, rgb=goal.rgb.rgb(sensor), weight=goal.weight)


def _free_range(file: SpecFile, name: str, colours: FreeRange, sensor: Sensor) -> tuple[Array, Array]:
    low, high = colours.low.rgb(sensor), colours.high.rgb(sensor)
    if not (low < high).all():
        text = f"must have low < high in every channel, got {low.round(4).tolist()} and {high.round(4).tolist()}"
        file.fail(("free", name), text, code="empty-range", hint="widen the range")
    return low, high


def _check_known(file: SpecFile, keys: tuple[Key, ...], name: str, known: Mapping[str, object], kind: str) -> None:
    if name not in known:
        error = unknown_name(name, known, kind)
        file.fail(keys, error.problem, code=error.code, hint=error.hint)
