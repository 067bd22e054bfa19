"""Colour space of an image file: OpenEXR chromaticities, PNG code points, or an ICC profile.

LittleCMS, through Pillow, reads ICC profiles. Matrix profiles, as displays have them, state their primaries. Of
profiles with lookup tables only the tone curve is known.
"""

from __future__ import annotations

import io
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

GREY_CODES = np.repeat(np.arange(256.0)[:, None], 3, axis=1)
"""8-bit RGB codes (256, 3) of the grey axis, black to white."""
H273_PRIMARIES = {
    1: SRGB,
    9: Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), SRGB.white),
    12: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), SRGB.white),
}
"""Colour primaries of ITU-T H.273, table 2, that PNG files name: sRGB, Rec. 2020 and Display P3."""
H273_SRGB_TRANSFER = 13
"""Transfer characteristics of sRGB in ITU-T H.273, table 3."""
D50 = (0.3457, 0.3585)
"""White point of the ICC profile connection space."""
MAX_PRIMARIES_DIFFERENCE = 5e-3
"""Largest difference in linear RGB between primaries that count as equal."""
MAX_CURVE_DIFFERENCE = 2.0
"""Largest difference in 8-bit sRGB codes between tone curves that count as equal."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Colour space that an image file states. Fields are None where the profile cannot be read.

    Parameters
    ----------
    name : str
        Name of the profile, empty if it has none.
    primaries : Primaries or None
        Chromaticities of the primaries and of white.
    greys : ndarray of shape (256, 3) or None
        8-bit sRGB codes of the profile's grey axis.
    """

    name: str
    primaries: Primaries | None
    greys: Array | None

    def mismatch(self, sensor: Sensor, *, encoded: bool) -> str:
        """Describe the difference from a sensor's RGB space.

        Parameters
        ----------
        sensor : Sensor
            The sensor whose space the colours are interpreted in.
        encoded : bool
            Whether to compare tone curves, too.

        Returns
        -------
        str
            The difference, empty if the spaces agree.
        """
        differences = []
        if self.primaries is None:
            differences.append("unreadable primaries")
        elif np.abs(conversion(self.primaries, sensor) - np.eye(3)).max() > MAX_PRIMARIES_DIFFERENCE:
            differences.append("other primaries")
        if encoded:
            differences += self._curve_mismatch(sensor)
        return " and ".join(differences)

    def _curve_mismatch(self, sensor: Sensor) -> list[str]:
        if self.greys is None:
            return ["an unreadable tone curve"]
        difference = np.abs(self.greys - 255 * encode(sensor.decoding)[:, None]).max()
        return ["another tone curve"] if difference > MAX_CURVE_DIFFERENCE else []


def read_profile(spec: Any) -> Profile | None:
    """Return the profile in an `OpenImageIO.ImageSpec`, None if the file states no colour space."""
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        return Profile("", _primaries(chromaticities), None)
    if (points := spec.getattribute("CICP")) is not None:
        if not isinstance(points, tuple) or len(points) < 2:
            return Profile("CICP", None, None)
        greys = GREY_CODES if points[1] == H273_SRGB_TRANSFER else None
        return Profile(f"CICP {points[0]}, {points[1]}", H273_PRIMARIES.get(points[0]), greys)
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = spec.get_string_attribute("ICCProfile:profile_description") or "an ICC profile without a name"
        is_bytes = isinstance(data, np.ndarray) and data.dtype == np.uint8
        return _read_icc(name, data.tobytes()) if is_bytes else Profile(name, None, None)
    return None


def _primaries(numbers: Any) -> Primaries | None:
    """Return primaries; None for impossible ones, and for values of another type, as an attribute may have any."""
    try:
        return Primaries.of([float(number) for number in numbers])
    except (OptionError, TypeError, ValueError):
        return None


def _read_icc(name: str, data: bytes) -> Profile:
    from PIL import ImageCms

    try:
        icc = ImageCms.ImageCmsProfile(io.BytesIO(data))
    except OSError:
        return Profile(name, None, None)
    primaries = (icc.profile.red_primary, icc.profile.green_primary, icc.profile.blue_primary)
    numbers = [number for each in primaries if each is not None for number in each[1][:2]]
    return Profile(name, _primaries((*numbers, *D50)), _greys(icc))


def _greys(profile: ImageCmsProfile) -> Array | None:
    from PIL import Image, ImageCms

    grey, srgb = Image.fromarray(GREY_CODES[None].astype(np.uint8)), ImageCms.createProfile("sRGB")
    try:
        in_srgb = ImageCms.profileToProfile(grey, profile, srgb, ImageCms.Intent.RELATIVE_COLORIMETRIC)
    except ImageCms.PyCMSError:
        return None
    return np.asarray(in_srgb, dtype=float)[0]
