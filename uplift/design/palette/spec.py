"""A palette as TOML (docs/palette.md) → `Palette`."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import PaletteError
from uplift.design.palette import spec_entries
from uplift.design.palette.factor import COUNTS
from uplift.design.palette.fields import Fields
from uplift.design.palette.palette import ColourGoal, MinDifference, Palette, SpectrumSpec

DARKEST, LIGHTEST = "#000000", "#ffffff"
"""Bounds of free colours: what a screen shows."""


def read_palette(path: str | os.PathLike[str]) -> Palette:
    """Read a spec, with the atlases and cubes that it names; their paths start where the spec lies.

    Raises
    ------
    PaletteError : with the table, the key and a hint; and whatever atlases, cubes and names raise.
    """
    root = Fields(path, "", _parse(path))
    sensor = observer.sensor()
    lights = _parts(root.table("lights"), sensor, spec_entries.light)
    materials = _parts(root.table("materials"), sensor, spec_entries.material)
    free = _free(root.table("free"), sensor)
    goals = _wishes(root.table("colours"), sensor, materials, lights)
    free |= {name: _range(Fields(path, name, {}), sensor) for name in _shared(goals) if name not in free}
    palette = Palette(
        sensor,
        lights,
        materials,
        goals,
        free,
        tuple(_apart(one, materials, lights) for one in root.tables("apart")),
        root.number("smoothness", Palette.smoothness, least=0),
        root.number("model-error", Palette.model_error, least=0),
        _count(root),
    )
    root.finish()
    return palette


def _parse(path: str | os.PathLike[str]) -> dict[str, Any]:
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        # TOML and UTF-8 raise kinds of ValueError, as does a NUL in a path; tables that nest deeply RecursionError.
        reason = getattr(error, "strerror", None) or str(error)
        raise PaletteError(f"cannot be read: {reason}", path=path, hint="write a spec in TOML") from None


def _parts(
    fields: Fields, sensor: Sensor, make: Callable[[str, Fields, Sensor], SpectrumSpec]
) -> tuple[SpectrumSpec, ...]:
    if not fields.values:
        raise fields.error("there are none", "name at least one")
    return tuple(make(fields.name(name), fields.table(name), sensor) for name in fields.values)


def _wishes(
    fields: Fields, sensor: Sensor, materials: tuple[SpectrumSpec, ...], lights: tuple[SpectrumSpec, ...]
) -> tuple[ColourGoal, ...]:
    goals: list[ColourGoal] = []
    for material in fields.values:
        row = fields.table(material)
        _known(row, material, materials, "material")
        for light, value in row.values.items():
            _known(row, light, lights, "light")
            goals.append(_wish(row, material, light, value, sensor))
    return tuple(goals)


def _wish(row: Fields, material: str, light: str, value: object, sensor: Sensor) -> ColourGoal:
    """A colour alone, or a table of a colour or a free one, and its weight."""
    if not isinstance(value, dict):
        return ColourGoal(material, light, rgb=row.as_colour(light, value, sensor))
    fields = row.table(light)
    weight = fields.number("weight", 1.0, least=0)
    if fields.has("free"):
        wish = ColourGoal(material, light, free=fields.name(fields.text("free")), weight=weight)
    else:
        wish = ColourGoal(material, light, rgb=fields.colour("rgb", sensor), weight=weight)
    fields.finish()
    return wish


def _free(fields: Fields, sensor: Sensor) -> dict[str, tuple[Array, Array]]:
    return {name: _range(fields.table(name), sensor) for name in fields.values}


def _range(fields: Fields, sensor: Sensor) -> tuple[Array, Array]:
    low, high = fields.colour("low", sensor, DARKEST), fields.colour("high", sensor, LIGHTEST)
    if not (low < high).all():
        raise fields.error("'low' is not below 'high' in every channel", "widen the range")
    fields.finish()
    return low, high


def _shared(wishes: tuple[ColourGoal, ...]) -> list[str]:
    return [wish.free for wish in wishes if wish.free is not None]


def _apart(
    fields: Fields, materials: tuple[SpectrumSpec, ...], lights: tuple[SpectrumSpec, ...]
) -> MinDifference:
    first, second = fields.names("materials", 2)
    for name in (first, second):
        _known(fields, name, materials, "material")
    light = fields.text("light")
    _known(fields, light, lights, "light")
    apart = MinDifference((first, second), light, fields.number("delta-e", least=0))
    fields.finish()
    return apart


def _known(fields: Fields, name: str, parts: tuple[SpectrumSpec, ...], kind: str) -> None:
    names = [part.name for part in parts]
    if name not in names:
        raise fields.unknown(name, names, kind)


def _count(root: Fields) -> int:
    count = root.number("coefficients", Palette.count)
    if count not in COUNTS:
        raise root.error(f"'coefficients' is {count:g}", f"take {COUNTS[0]} to {COUNTS[-1]}")
    return int(count)
