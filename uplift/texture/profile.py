"""What a file says its RGB are of: chromaticities of OpenEXR, code points of a PNG, or an ICC profile.

Of ICC profiles (ICC.1:2022) those are read that have three colorants and a curve, as those of displays do.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.errors import OptionError
from uplift.overflow import SRGB, Primaries, conversion
from uplift.sensor import Array, Sensor

CODES = np.linspace(0, 1, 256)
CODE_POINTS = {
    1: SRGB,
    9: Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), SRGB.white),
    12: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), SRGB.white),
}
"""Colour primaries of ITU-T H.273, table 2, that PNG files name: those of sRGB, Rec. 2020 and Display P3."""
SRGB_TRANSFER = 13
"""Of the transfer characteristics of ITU-T H.273, table 3."""
SRGB_CURVE = (2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)
PARAMETERS = (1, 3, 4, 5, 7)
"""Numbers of each kind of parametric curve of ICC profiles."""
SAME_PRIMARIES = 5e-3
"""By which linear RGB may differ."""
SAME_CURVE = 2.0
"""By which 8-bit codes may differ."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Its name, if it has one; primaries and white, and linear values (256,) of 8-bit codes, where they can be read."""

    name: str
    primaries: Primaries | None
    curve: Array | None

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
        if self.curve is None:
            return ["a curve that cannot be read"]
        apart = np.interp(self.curve, sensor.decoding, 255 * CODES) - 255 * CODES
        return ["another curve"] if np.abs(apart).max() > SAME_CURVE else []


def profile_of(spec: Any) -> Profile | None:
    """What an `OpenImageIO.ImageSpec` says, if it says something."""
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        return Profile("", _primaries(chromaticities), None)
    if (points := spec.getattribute("CICP")) is not None:
        curve = _parametric(3, SRGB_CURVE) if points[1] == SRGB_TRANSFER else None
        return Profile(f"CICP {points[0]}, {points[1]}", CODE_POINTS.get(points[0]), curve)
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = spec.get_string_attribute("ICCProfile:profile_description") or "an ICC profile without a name"
        tags = _tags(np.asarray(data, dtype=np.uint8).tobytes())
        return Profile(name, _colorants(tags), _curve(tags.get(b"gTRC", b"")))
    return None


def _primaries(numbers: Iterable[float]) -> Primaries | None:
    try:
        return Primaries.of([float(number) for number in numbers])
    except OptionError:
        return None


def _tags(data: bytes) -> dict[bytes, bytes]:
    """What lies under each signature; nothing where the profile is cut short."""
    try:
        (count,) = struct.unpack_from(">I", data, 128)
        entries = [struct.unpack_from(">4sII", data, 132 + 12 * index) for index in range(count)]
    except struct.error:
        return {}
    return {name: data[start : start + size] for name, start, size in entries}


def _colorants(tags: dict[bytes, bytes]) -> Primaries | None:
    """They are adapted to D50, which is their sum; `conversion` adapts it onwards, by the same transform."""
    try:
        xyz = [struct.unpack_from(">3i", tags[name], 8) for name in (b"rXYZ", b"gXYZ", b"bXYZ")]
    except (KeyError, struct.error):
        return None
    rows = np.array([*xyz, np.sum(xyz, axis=0)], dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _primaries((rows[:, :2] / rows.sum(axis=1, keepdims=True)).ravel())


def _curve(tag: bytes) -> Array | None:
    """Linear values (256,) of a ``curv`` or a ``para`` (ICC.1:2022, 10.6 and 10.18)."""
    try:
        if tag[:4] == b"para":
            (kind,) = struct.unpack_from(">H", tag, 8)
            numbers = struct.unpack_from(f">{PARAMETERS[kind]}i", tag, 12)
            return _parametric(kind, tuple(number / 65536 for number in numbers))
        (count,) = struct.unpack_from(">I", tag, 8)
        table = np.array(struct.unpack_from(f">{count}H", tag, 12), dtype=float)
    except (IndexError, struct.error):
        return None
    if tag[:4] != b"curv":
        return None
    if count < 2:
        return np.asarray(CODES ** (table[0] / 256 if count else 1))
    return np.interp(CODES, np.linspace(0, 1, count), table / 65535)


def _parametric(kind: int, numbers: tuple[float, ...]) -> Array:
    """(aX + b)^g + e from d on, cX + f below."""
    g, a, b, c, d, e, f = (*numbers, *(0.0,) * (7 - len(numbers)))
    if kind == 0:
        a = 1.0
    elif kind < 3:  # what lies below d is constant
        c, d, e, f = 0.0, -b / a if a else 0.0, c, c
    with np.errstate(all="ignore"):
        found = np.where(d <= CODES, np.maximum(a * CODES + b, 0) ** g + e, c * CODES + f)
    return np.clip(np.nan_to_num(found), 0, 1)
