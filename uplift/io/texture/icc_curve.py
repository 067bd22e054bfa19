"""Tone curves of ICC profiles (ICC.1:2022, 10.6 curveType and 10.18 parametricCurveType).

LittleCMS, through Pillow, evaluates them with 8 bits only.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array

TAGS = (b"rTRC", b"gTRC", b"bTRC")
GREY_TAG = b"kTRC"
MAX_TAGS = 100
FIXED = 65536.0
"""Scale of s15Fixed16 numbers."""
PARAMETERS = (1, 3, 4, 5, 7)
"""Parameters of each function type."""


@dataclass(frozen=True, eq=False)
class ToneCurves:
    """Curves of red, green and blue: from codes (..., 3) to linear RGB (..., 3)."""

    curves: tuple[Callable[[Array], Array], ...]

    def __call__(self, codes: Array) -> Array:
        """Evaluate the curves."""
        channels = [curve(codes[..., channel]) for channel, curve in enumerate(self.curves)]
        return np.stack(channels, axis=-1)


def read_curves(profile: bytes) -> ToneCurves | None:
    """Return the tone curves of a matrix or grey profile; None for others, and for damaged ones."""
    try:
        tags = _tags(profile)
        names = TAGS if all(name in tags for name in TAGS) else (GREY_TAG,) * 3
        curves = ToneCurves(tuple(_curve(tags[name]) for name in names))
        values = curves(np.linspace([0.0] * 3, [1.0] * 3, 256))
    except (KeyError, ValueError, struct.error):
        return None
    is_plausible = np.isfinite(values).all() and np.ptp(values[[0, -1]], axis=0).min() > 0.5
    return curves if is_plausible and (np.diff(values, axis=0) >= 0).all() else None


def _tags(profile: bytes) -> dict[bytes, bytes]:
    (count,) = struct.unpack_from(">I", profile, 128)
    entries = (struct.unpack_from(">4sII", profile, 132 + 12 * index) for index in range(min(count, MAX_TAGS)))
    return {name: profile[start : start + size] for name, start, size in entries}


def _curve(tag: bytes) -> Callable[[Array], Array]:
    kind = tag[:4]
    if kind == b"curv":
        return _sampled(tag)
    if kind == b"para":
        return _parametric(tag)
    raise ValueError("another type of curve")


def _sampled(tag: bytes) -> Callable[[Array], Array]:
    (count,) = struct.unpack_from(">I", tag, 8)
    if count == 0:
        return lambda codes: codes
    if 12 + 2 * count > len(tag):
        raise ValueError("the curve is cut short")
    numbers = np.frombuffer(tag, ">u2", count, 12)
    if count == 1:
        return _power(float(numbers[0]) / 256)
    positions, table = np.linspace(0, 1, count), numbers / 65535
    return lambda codes: np.interp(codes, positions, table)


def _power(gamma: float) -> Callable[[Array], Array]:
    return lambda codes: np.maximum(codes, 0) ** gamma


def _parametric(tag: bytes) -> Callable[[Array], Array]:
    (kind,) = struct.unpack_from(">H", tag, 8)
    if kind >= len(PARAMETERS):
        raise ValueError("another function")
    numbers = [number / FIXED for number in struct.unpack_from(f">{PARAMETERS[kind]}i", tag, 12)]
    g, a, b, c, d, e, f = _all_parameters(kind, numbers)

    def evaluate(codes: Array) -> Array:
        with np.errstate(all="ignore"):
            return np.where(codes >= d, np.maximum(a * codes + b, 0) ** g + e, c * codes + f)

    return evaluate


def _all_parameters(kind: int, numbers: Sequence[float]) -> tuple[float, ...]:
    """Return g, a, b, c, d, e, f of Y = (aX + b)^g + e for X ≥ d, else cX + f."""
    g, a, b = (*numbers, 1.0, 0.0)[:3] if kind == 0 else numbers[:3]
    if kind == 0:
        return g, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if kind < 3:
        constant = numbers[3] if kind == 2 else 0.0
        return g, a, b, 0.0, -b / a if a else 0.0, constant, constant
    c, d = numbers[3:5]
    e, f = numbers[5:7] if kind == 4 else (0.0, 0.0)
    return g, a, b, c, d, e, f
