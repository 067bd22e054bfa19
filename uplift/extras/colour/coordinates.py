"""Classical coordinates of colours: HSV, HSL, YIQ, dominant wavelength and purity
(Fishkin 1983, 3.11–3.13).
"""

import colorsys
from collections.abc import Mapping
from typing import Any

from uplift.common.arrays import Array
from uplift.extras.colour.dominant import dominant_wavelengths
from uplift.lookup.cube import Cube


def coordinates(cube: Cube, rgb: Array) -> dict[str, list[Any]]:
    """Return the coordinates of linear RGB (n, 3) by name, None where a grey has no
    dominant wavelength. Empty for a camera, whose values no display shows.

    HSV, HSL and YIQ are those of the encoded components, as displays and broadcasts use
    them, clipped to [0, 1].
    """
    sensor = cube.data.sensor
    if sensor.sensitivities is not None:
        return {}
    encoded = (cube.encode(rgb) / 255).T.tolist()
    hls = map(colorsys.rgb_to_hls, *encoded)
    # one by one, as the rounding of a product depends on its size
    xyz = sensor.xyz(rgb[:, None])[:, 0]
    wavelengths, complementary, purity = dominant_wavelengths(xyz, sensor)
    return {
        "hsv": list(map(list, map(colorsys.rgb_to_hsv, *encoded))),
        "hsl": [[hue, saturation, lightness] for hue, lightness, saturation in hls],
        "yiq": list(map(list, map(colorsys.rgb_to_yiq, *encoded))),
        "dominant_wavelength": [
            None if wavelength != wavelength else wavelength
            for wavelength in wavelengths.tolist()
        ],
        "complementary": complementary.tolist(),
        "purity": purity.tolist(),
    }


def describe(values: Mapping[str, Any]) -> dict[str, str]:
    """Describe the hue and the encoded components of one colour; empty for a camera."""
    if "hsv" not in values:
        return {}
    kind = "complement of " if values["complementary"] else ""
    wavelength = values["dominant_wavelength"]
    hue = "grey"
    if wavelength is not None:
        hue = f"{kind}{wavelength:.0f} nm, purity {values['purity']:.2f}"
    codes = []
    for name in ("hsv", "hsl", "yiq"):
        first, second, third = (round(value, 2) + 0.0 for value in values[name])
        if name != "yiq":
            first %= 1  # a hue of 1 is 0
        codes.append(f"{name.upper()} {first:.2f} {second:.2f} {third:.2f}")
    return {"hue": hue, "encoded": ", ".join(codes)}
