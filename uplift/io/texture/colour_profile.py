"""What a file says its RGB are of: chromaticities of OpenEXR, code points of a PNG, or an ICC profile.

ICC profiles are read by LittleCMS, through Pillow. It tells the primaries of those that have a matrix, as those of
displays do; of those that have tables in its place, the curve alone.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries, conversion
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

if TYPE_CHECKING:
    from PIL.ImageCms import ImageCmsProfile

CODES = np.repeat(np.arange(256.0)[:, None], 3, axis=1)
"""Grey, from black to white."""
CODE_POINTS = {
    1: SRGB,
    9: Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), SRGB.white),
    12: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), SRGB.white),
}
"""Colour primaries of ITU-T H.273, table 2, that PNG files name: those of sRGB, Rec. 2020 and Display P3."""
SRGB_TRANSFER = 13
"""Of the transfer characteristics of ITU-T H.273, table 3."""
D50 = (0.3457, 0.3585)
"""White of what ICC profiles are connected by; `conversion` adapts from it by the transform that profiles have."""
SAME_PRIMARIES = 5e-3
"""By which linear RGB may differ."""
SAME_CURVE = 2.0
"""By which 8-bit codes of sRGB may differ."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Its name, if it has one; primaries and white, and 8-bit codes (256, 3) that sRGB has for its greys.

    None is what cannot be read.
    """

    name: str
    primaries: Primaries | None
    greys: Array | None

    def unlike(self, sensor: Sensor, *, codes: bool) -> str:
        """What is not the sensor's; of ``codes`` the curve is looked at too. Empty where all is alike."""
        found = []
        if self.primaries is None:
            found.append("primaries that cannot be read")
        elif np.abs(conversion(self.primaries, sensor) - np.eye(3)).max() > SAME_PRIMARIES:
            found.append("other primaries")
        if codes:
            found += self._curve_unlike(sensor)
        return " and ".join(found)

    def _curve_unlike(self, sensor: Sensor) -> list[str]:
        if self.greys is None:
            return ["a curve that cannot be read"]
        apart = self.greys - 255 * encode(sensor.decoding)[:, None]
        return ["another curve"] if np.abs(apart).max() > SAME_CURVE else []


def profile_of(spec: Any) -> Profile | None:
    """What an `OpenImageIO.ImageSpec` says, if it says something."""
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        return Profile("", _primaries(chromaticities), None)
    if (points := spec.getattribute("CICP")) is not None:
        greys = CODES if points[1] == SRGB_TRANSFER else None
        return Profile(f"CICP {points[0]}, {points[1]}", CODE_POINTS.get(points[0]), greys)
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = spec.get_string_attribute("ICCProfile:profile_description") or "an ICC profile without a name"
        return _icc(name, np.asarray(data, dtype=np.uint8).tobytes())
    return None


def _primaries(numbers: Iterable[float]) -> Primaries | None:
    try:
        return Primaries.of([float(number) for number in numbers])
    except OptionError:
        return None


def _icc(name: str, data: bytes) -> Profile:
    from PIL import ImageCms

    try:
        found = ImageCms.ImageCmsProfile(io.BytesIO(data))
    except OSError:
        return Profile(name, None, None)
    lights = (found.profile.red_primary, found.profile.green_primary, found.profile.blue_primary)
    numbers = [number for light in lights if light is not None for number in light[1][:2]]
    return Profile(name, _primaries((*numbers, *D50)), _greys(found))


def _greys(profile: ImageCmsProfile) -> Array | None:
    from PIL import Image, ImageCms

    grey, srgb = Image.fromarray(CODES[None].astype(np.uint8)), ImageCms.createProfile("sRGB")
    try:
        shown = ImageCms.profileToProfile(grey, profile, srgb, ImageCms.Intent.RELATIVE_COLORIMETRIC)
    except ImageCms.PyCMSError:
        return None
    return np.asarray(shown, dtype=float)[0]
