"""Colour space that an image file states: colorInteropID or chromaticities of OpenEXR, PNG code points, or ICC.

Matrix profiles, as displays have them, state their primaries and tone curves. LittleCMS, through Pillow, reads the
primaries. Profiles with lookup tables are not used.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.colorimetry.ocio import find_ocio_space
from uplift.colorimetry.spaces import ImageSpace, from_ocio
from uplift.colorimetry.srgb import decode
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.io.texture.icc_curve import read_curves

H273_PRIMARIES = {
    1: SRGB,
    9: Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), SRGB.white),
    11: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.314, 0.351)),
    12: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), SRGB.white),
}
"""Colour primaries of ITU-T H.273, table 2, that PNG files name: sRGB, Rec. 2020, DCI-P3 and Display P3."""
D50 = (0.3457, 0.3585)
"""White point of the ICC profile connection space."""
GREY = b"GRAY"
NOT_STATED = ("", "unknown")
"""Values of colorInteropID that name no space."""


def _decode_bt709(codes: Array) -> Array:
    """Invert the transfer function of ITU-R BT.709, which BT.2020 shares."""
    return np.where(codes < 0.081, codes / 4.5, (np.maximum(codes, 0.081) + 0.099) / 1.099) ** np.where(
        codes < 0.081, 1, 1 / 0.45
    )


def _power(gamma: float) -> Callable[[Array], Array]:
    return lambda codes: np.maximum(codes, 0) ** gamma


def _linear(codes: Array) -> Array:
    return codes


H273_TRANSFERS: dict[int, Callable[[Array], Array]] = {
    **dict.fromkeys((1, 6, 14, 15), _decode_bt709),
    4: _power(2.2),
    5: _power(2.8),
    8: _linear,
    13: decode,
    17: lambda codes: _power(2.6)(codes) * 52.37 / 48,
}
"""Inverse transfer characteristics of ITU-T H.273, table 3, without those of high dynamic range."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Statement of an image file about its colour space.

    Parameters
    ----------
    name : str
        Name of the space or profile, empty if it has none.
    space : ImageSpace or None
        The space; None if the statement cannot be used.
    """

    name: str
    space: ImageSpace | None


def read_profile(spec: Any) -> Profile | None:
    """Return the profile in an `OpenImageIO.ImageSpec`, None if the file states no colour space."""
    interop = str(spec.get_string_attribute("colorInteropID"))
    if interop not in NOT_STATED:
        return _by_interop_id(interop)
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        primaries = _primaries(chromaticities)
        name = "chromaticities"
        return Profile(name, None if primaries is None else ImageSpace(name, primaries))
    if (points := spec.getattribute("CICP")) is not None:
        return _by_code_points(points)
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = spec.get_string_attribute("ICCProfile:profile_description") or "an ICC profile without a name"
        is_bytes = isinstance(data, np.ndarray) and data.dtype == np.uint8
        return _read_icc(name, data.tobytes()) if is_bytes else Profile(name, None)
    return None


def _by_interop_id(name: str) -> Profile:
    """Return the space of a name of the Color Interop Forum, which the configuration of OpenColorIO has as alias."""
    try:
        found = find_ocio_space(name)
    except OptionError:
        found = None
    return Profile(name, None if found is None else from_ocio(found))


def _by_code_points(points: Any) -> Profile:
    if not isinstance(points, tuple) or len(points) < 2:
        return Profile("CICP", None)
    name = f"CICP {points[0]}, {points[1]}"
    primaries, transfer = H273_PRIMARIES.get(points[0]), H273_TRANSFERS.get(points[1])
    known = primaries is not None and transfer is not None
    return Profile(name, ImageSpace(name, primaries, transfer) if known and primaries is not None else None)


def _primaries(numbers: Any) -> Primaries | None:
    """Return primaries; None for impossible ones, and for values of another type, as an attribute may have any."""
    try:
        return Primaries.of([float(number) for number in numbers])
    except (OptionError, TypeError, ValueError):
        return None


def _read_icc(name: str, data: bytes) -> Profile:
    from PIL import ImageCms

    curves = read_curves(data)
    try:
        icc = ImageCms.ImageCmsProfile(io.BytesIO(data))
    except OSError:
        return Profile(name, None)
    primaries = (icc.profile.red_primary, icc.profile.green_primary, icc.profile.blue_primary)
    numbers = [number for each in primaries if each is not None for number in each[1][:2]]
    gamut = SRGB if data[16:20] == GREY else _primaries((*numbers, *D50))
    return Profile(name, None if gamut is None or curves is None else ImageSpace(name, gamut, curves))
