"""Classical coordinates of a colour: HSV, HSL, YIQ, dominant wavelength and purity (Fishkin 1983, 3.11–3.13)."""

from __future__ import annotations

import colorsys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup import Cube


def coordinates(cube: Cube, rgb: Array) -> dict[str, Any]:
    """Return the coordinates of linear RGB (3,) for JSON; empty for a camera, whose values no display shows.

    HSV, HSL and YIQ are those of the encoded components, as displays and broadcasts use them, clipped to [0, 1].
    """
    from uplift.colorimetry.dominant import dominant_wavelength

    sensor = cube.data.sensor
    if sensor.sensitivities is not None:
        return {}
    encoded = (cube.encode(rgb) / 255).tolist()
    hue, lightness, saturation = colorsys.rgb_to_hls(*encoded)
    found = dominant_wavelength(sensor.xyz(rgb), sensor)
    return {
        "hsv": list(colorsys.rgb_to_hsv(*encoded)),
        "hsl": [hue, saturation, lightness],
        "yiq": list(colorsys.rgb_to_yiq(*encoded)),
        "dominant_wavelength": found.wavelength,
        "complementary": found.complementary,
        "purity": found.purity,
    }


def describe(cube: Cube, rgb: Array) -> dict[str, str]:
    """Return the coordinates of linear RGB (3,) for a table, by the name of the row; empty for a camera."""
    values = coordinates(cube, rgb)
    if not values:
        return {}
    kind = "complement of " if values["complementary"] else ""
    wavelength = values["dominant_wavelength"]
    hue = "grey" if wavelength is None else f"{kind}{wavelength:.0f} nm, purity {values['purity']:.2f}"
    codes = (f"{name.upper()} {' '.join(f'{x:.2f}' for x in values[name])}" for name in ("hsv", "hsl", "yiq"))
    return {"hue": hue, "encoded": ", ".join(codes)}
