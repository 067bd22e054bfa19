"""Colour space that an image file states: colorInteropID or chromaticities of OpenEXR, PNG code points, or ICC.

Matrix profiles, as displays have them, state their primaries, adapted to D50, and tone curves (ICC.1:2022, 8.4.3).
Profiles with lookup tables are not used.
"""

import contextlib
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.colorimetry.spaces import ImageSpace, find_ocio_space
from uplift.colorimetry.srgb import decode
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

Curve = Callable[[Array], Array]
"""From codes in [0, 1] to linear values."""

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
COLORANTS = (b"rXYZ", b"gXYZ", b"bXYZ")
TONE_CURVES = (b"rTRC", b"gTRC", b"bTRC")
GREY_CURVE = b"kTRC"
MAX_TAGS = 100
FIXED = 65536.0
"""Scale of s15Fixed16 numbers."""
PARAMETERS = (1, 3, 4, 5, 7)
"""Number of parameters of each function type of ICC.1:2022, 10.18."""


def _decode_bt709(codes: Array) -> Array:
    """Invert the transfer function of ITU-R BT.709, which BT.2020 shares."""
    return np.where(codes < 0.081, codes / 4.5, (np.maximum(codes, 0.081) + 0.099) / 1.099) ** np.where(
        codes < 0.081, 1, 1 / 0.45
    )


def _power(gamma: float) -> Curve:
    return lambda codes: np.maximum(codes, 0) ** gamma


def _linear(codes: Array) -> Array:
    return codes


H273_TRANSFERS: dict[int, Curve] = {
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
    """Statement of an image file about its colour space; ``space`` is None if it cannot be used."""

    name: str
    space: ImageSpace | None


def read_profile(spec: Any) -> Profile | None:
    """Return the profile in an `OpenImageIO.ImageSpec`, None if the file states no colour space."""
    interop = str(spec.get_string_attribute("colorInteropID"))
    if interop not in NOT_STATED:
        # A name of the Color Interop Forum, which the configuration of OpenColorIO has as alias.
        found = None
        with contextlib.suppress(OptionError):
            found = find_ocio_space(interop)
        return Profile(interop, None if found is None else found.as_image_space())
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        primaries = _primaries(chromaticities)
        name = "chromaticities"
        return Profile(name, None if primaries is None else ImageSpace(name, primaries))
    if (points := spec.getattribute("CICP")) is not None:
        return _by_code_points(points)
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = spec.get_string_attribute("ICCProfile:profile_description") or "an ICC profile without a name"
        is_bytes = isinstance(data, np.ndarray) and data.dtype == np.uint8
        return Profile(name, _icc_space(name, data.tobytes()) if is_bytes else None)
    return None


def _by_code_points(points: Any) -> Profile:
    pair = points[:2] if isinstance(points, tuple) and len(points) > 1 else (0, 0)
    name = f"CICP {pair[0]}, {pair[1]}"
    primaries, transfer = H273_PRIMARIES.get(pair[0]), H273_TRANSFERS.get(pair[1])
    return Profile(name, None if primaries is None or transfer is None else ImageSpace(name, primaries, transfer))


def _primaries(numbers: Any) -> Primaries | None:
    """Return primaries; None for impossible ones, and for values of another type, as an attribute may have any."""
    try:
        return Primaries.of([float(number) for number in numbers])
    except (OptionError, TypeError, ValueError):
        return None


def _icc_space(name: str, data: bytes) -> ImageSpace | None:
    """Return the space of a matrix or grey profile; None for others, and for damaged ones."""
    try:
        (count,) = struct.unpack_from(">I", data, 128)
        entries = (struct.unpack_from(">4sII", data, 132 + 12 * index) for index in range(min(count, MAX_TAGS)))
        tags = {tag: data[start : start + size] for tag, start, size in entries}
        curves = _tone_curves(tags)
        xyz = [] if data[16:20] == GREY else [struct.unpack_from(">3i", tags[colorant], 8) for colorant in COLORANTS]
        numbers = [part / sum(each) for each in xyz for part in each[:2]]
    except (KeyError, ValueError, ZeroDivisionError, struct.error):
        return None
    gamut = _primaries((*numbers, *D50)) if numbers else SRGB
    return None if gamut is None or curves is None else ImageSpace(name, gamut, curves)


def _tone_curves(tags: Mapping[bytes, bytes]) -> Curve | None:
    """Return the tone curves (…, 3), None for implausible ones. Raises `KeyError`, `ValueError`, `struct.error`."""
    names = TONE_CURVES if all(name in tags for name in TONE_CURVES) else (GREY_CURVE,) * 3
    curves = [_tone_curve(tags[name]) for name in names]

    def evaluate(codes: Array) -> Array:
        return np.stack([curve(codes[..., channel]) for channel, curve in enumerate(curves)], axis=-1)

    values = evaluate(np.linspace([0.0] * 3, [1.0] * 3, 256))
    is_plausible = np.isfinite(values).all() and np.ptp(values[[0, -1]], axis=0).min() > 0.5
    return evaluate if is_plausible and (np.diff(values, axis=0) >= 0).all() else None


def _tone_curve(tag: bytes) -> Curve:
    """Read a curve (ICC.1:2022, 10.6 curveType and 10.18 parametricCurveType). Raises `ValueError`."""
    if tag[:4] == b"para":
        (kind,) = struct.unpack_from(">H", tag, 8)
        if kind >= len(PARAMETERS):
            raise ValueError("another function")
        return _parametric([number / FIXED for number in struct.unpack_from(f">{PARAMETERS[kind]}i", tag, 12)])
    if tag[:4] != b"curv":
        raise ValueError("another type of curve")
    (count,) = struct.unpack_from(">I", tag, 8)
    if count == 0:
        return _linear
    if 12 + 2 * count > len(tag):
        raise ValueError("the curve is cut short")
    numbers = np.frombuffer(tag, ">u2", count, 12)
    if count == 1:
        return _power(float(numbers[0]) / 256)
    positions, table = np.linspace(0, 1, count), numbers / 65535
    return lambda codes: np.interp(codes, positions, table)


def _parametric(parameters: list[float]) -> Curve:
    """Return Y = (aX + b)^g + e for X ≥ d, else cX + f; the function type follows from the number of parameters."""
    g, a, b, c, d, e, f = 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    match parameters:
        case [g]:
            pass
        case [g, a, b]:
            d = -b / a if a else 0.0
        case [g, a, b, e]:
            d, f = -b / a if a else 0.0, e
        case _:
            g, a, b, c, d, e, f = (*parameters, e, f)[:7]

    def evaluate(codes: Array) -> Array:
        with np.errstate(all="ignore"):
            return np.where(codes >= d, np.maximum(a * codes + b, 0) ** g + e, c * codes + f)

    return evaluate
