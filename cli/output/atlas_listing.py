"""Rows of ``uplift atlas``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.colorimetry.sensor import Sensor


@dataclass(frozen=True)
class Row:
    """One entry: range in nm, linear RGB, 8-bit sRGB, and warnings."""

    name: str
    start: float
    end: float
    step: float | None
    rgb: tuple[float, float, float]
    swatch: tuple[int, int, int]
    in_gamut: bool
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Listing:
    """An atlas, its colours under one sensor, and the smallest common RGB space that holds all of them."""

    atlas: Atlas
    sensor: Sensor
    rows: tuple[Row, ...]
    smallest_space: str | None


def list_entries(atlas: Atlas, sensor: Sensor) -> Listing:
    """List all entries under a sensor, with reflectances clipped as in a build."""
    from uplift.atlas import resample
    from uplift.colorimetry.gamut import SRGB
    from uplift.colorimetry.observer import sensor as make_sensor
    from uplift.colorimetry.observer import smallest_space
    from uplift.colorimetry.srgb import to_display_codes

    resampled = resample(atlas, sensor.wavelengths)
    display = make_sensor("sRGB", sensor.illuminant, sensor.observer)
    clips = {clip.name: (str(clip),) for clip in resampled.clips}
    colours = sensor.rgb(resampled.values).tolist()
    codes = to_display_codes(display.rgb(resampled.values), SRGB).astype(int).tolist()
    rows = [
        Row(
            entry.name,
            float(entry.wavelengths[0]),
            float(entry.wavelengths[-1]),
            entry.step,
            tuple(rgb),
            tuple(code),
            bool(sensor.contains(rgb)),
            clips.get(entry.name, ()),
        )
        for entry, rgb, code in zip(atlas.entries, colours, codes, strict=True)
    ]
    smallest = smallest_space(resampled.values, sensor.illuminant, sensor.observer)
    return Listing(atlas, sensor, tuple(rows), smallest)
