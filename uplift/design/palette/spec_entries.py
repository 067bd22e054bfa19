"""Lights and materials of a spec: given by name, by temperature, by an atlas, by a colour, or to be designed."""

from __future__ import annotations

import math
from pathlib import Path

from uplift import lookup
from uplift.atlas import on_grid, read_atlas
from uplift.atlas.atlas import Atlas
from uplift.colorimetry.sensor import Sensor
from uplift.design.palette.fields import Fields
from uplift.design.palette.lights import illuminant, planck
from uplift.design.palette.palette import SpectrumSpec

LIGHT_KINDS, MATERIAL_KINDS = ["illuminant", "planck", "design"], ["atlas", "rgb", "design"]


def light(name: str, fields: Fields, sensor: Sensor) -> SpectrumSpec:
    """``illuminant`` or ``planck`` (K), with the ``luminance`` of white; or ``design`` with ``bounds`` of its power."""
    kind = _kind(fields, LIGHT_KINDS)
    if kind == "design":
        return _designed(name, fields, (0.0, math.inf))
    with_name = kind == "illuminant"
    power = illuminant(sensor, fields.text(kind)) if with_name else planck(sensor, fields.number(kind))
    part = SpectrumSpec(name, power * fields.number("luminance", 1.0, least=0.0))
    fields.finish()
    return part


def material(name: str, fields: Fields, sensor: Sensor) -> SpectrumSpec:
    """``atlas`` with ``entry``; ``rgb`` that a ``cube`` uplifts; or ``design``, with ``bounds`` of its reflectance."""
    kind = _kind(fields, MATERIAL_KINDS)
    if kind == "design":
        return _designed(name, fields, (0.0, 1.0))
    if kind == "atlas":
        spectra = _entry(fields, read_atlas(_beside(fields, "atlas")))
        part = SpectrumSpec(name, on_grid(spectra, sensor.wavelengths)[0])
    else:
        cube = lookup.load(_beside(fields, "cube") if fields.has("cube") else None)
        colour = fields.colour("rgb", cube.data.sensor)
        part = SpectrumSpec(name, cube.reflectance(colour, sensor.wavelengths))
    fields.finish()
    return part


def _kind(fields: Fields, kinds: list[str]) -> str:
    found = [kind for kind in kinds if fields.has(kind)]
    if len(found) != 1:
        told = " and ".join(f"'{kind}'" for kind in found) or "nothing"
        raise fields.error(f"is given by {told}", f"give it by one of {', '.join(kinds)}")
    return found[0]


def _designed(name: str, fields: Fields, bounds: tuple[float, float]) -> SpectrumSpec:
    fields.true("design")
    low, high = fields.bounds("bounds", bounds)
    fields.finish()
    return SpectrumSpec(name, None, low, high)


def _entry(fields: Fields, spectra: Atlas) -> Atlas:
    name = fields.text("entry")
    found = tuple(entry for entry in spectra.entries if entry.name == name)
    if not found:
        raise fields.unknown(name, list(spectra.names), "entry")
    return Atlas(found)


def _beside(fields: Fields, key: str) -> Path:
    """A path of the spec, which starts where the spec lies."""
    return Path(fields.path).parent / fields.text(key)
