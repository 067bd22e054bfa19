"""What ``uplift atlas`` says of each entry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.colorimetry.sensor import Sensor


@dataclass(frozen=True)
class Row:
    """One entry as it is listed: nm, linear RGB, display RGB (8 bit), and what was clipped."""

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
    """An atlas seen under one sensor."""

    spectra: Atlas
    sensor: Sensor
    rows: tuple[Row, ...]


def list_entries(spectra: Atlas, sensor: Sensor) -> Listing:
    """Colours of all entries under a sensor, clipped as a cube would have them."""
    from uplift.atlas import resample
    from uplift.colorimetry.gamut import SRGB
    from uplift.colorimetry.observer import sensor as make_sensor
    from uplift.colorimetry.srgb import to_display_codes

    resampled = resample(spectra, sensor.wavelengths)
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
        for entry, rgb, code in zip(spectra.entries, colours, codes, strict=True)
    ]
    return Listing(spectra, sensor, tuple(rows))
