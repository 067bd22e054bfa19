"""What painters expect of a mixture (10.4), measured: five criteria, and how far a way of mixing is from each.

The thesis says "maintains chromaticity" of tints too, though white draws every chromaticity to its own: what a tint
can keep is its hue, the direction from white in the u'v' diagram of 1976. A shade can keep its chromaticity itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb, rgb_to_lab
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.mixing.mixers import Mixer

BLACK, WHITE = np.zeros(3), np.ones(3)
COMPLEMENTS = (((0, 0, 1), (1, 0.5, 0)), ((1, 0, 0), (0, 1, 0)), ((1, 1, 0), (1, 0, 1)))
"""Blue and orange, red and green, yellow and purple, as full colours of RGB."""
BLUE, YELLOW = np.array([0.0, 0, 1]), np.array([1.0, 1, 0])
SHARES = np.array([(0.75, 0.25), (0.5, 0.5), (0.25, 0.75)])
"""Of shades, tints and greens."""


@dataclass(frozen=True)
class Criterion:
    """``limit`` is what its measure may be at most."""

    title: str
    measure: str
    limit: float


CRITERIA = (
    Criterion("mixed with itself: no change", "worst ΔE00", 0.1),
    Criterion("with black: chromaticity kept", "worst Δu'v'", 0.005),
    Criterion("with black: darker", "largest change of L*", 0.0),
    Criterion("with white: hue kept", "worst turn, degrees", 3.0),
    Criterion("with white: lighter", "largest fall of L*", 0.0),
    Criterion("with its complement: grey", "worst C*ab", 10.0),
    Criterion("blue and yellow: green", "max(R, B) − G at best", -0.01),
)


@dataclass(frozen=True)
class Verdict:
    """How far a mixer is from a criterion."""

    criterion: Criterion
    value: float

    @property
    def obeys(self) -> bool:
        return self.value <= self.criterion.limit


def judge(mixer: Mixer, sensor: Sensor, colours: Array) -> tuple[Verdict, ...]:
    """One verdict a criterion; the first five by linear RGB ``colours`` (n, 3), none of them grey."""
    shades, tints = (_with(mixer, colours, other) for other in (BLACK, WHITE))
    lightness = rgb_to_lab(sensor, colours)[:, None, 0]
    values = (
        float(delta_e_rgb(sensor, colours, _itself(mixer, colours)).max()),
        float(np.linalg.norm(_uv(sensor, shades) - _uv(sensor, colours)[:, None], axis=-1).max()),
        float((rgb_to_lab(sensor, shades)[..., 0] - lightness).max()),
        float(_turn(sensor, tints, colours[:, None]).max()),
        float((lightness - rgb_to_lab(sensor, tints)[..., 0]).max()),
        max(_chroma(sensor, _half(mixer, *pair)) for pair in COMPLEMENTS),
        _not_green(mixer.mix(np.stack([BLUE, YELLOW]), 2 * SHARES)),
    )
    return tuple(Verdict(criterion, value) for criterion, value in zip(CRITERIA, values, strict=True))


def _itself(mixer: Mixer, colours: Array) -> Array:
    return np.array([mixer.mix(np.stack([one, one]), np.ones(2)) for one in colours])


def _with(mixer: Mixer, colours: Array, other: Array) -> Array:
    """(n, shares, 3) mixtures of each colour with another."""
    return np.array([mixer.mix(np.stack([one, other]), 2 * SHARES) for one in colours])


def _half(mixer: Mixer, first: tuple[float, ...], second: tuple[float, ...]) -> Array:
    return mixer.mix(np.array([first, second], dtype=float), np.ones(2))


def _uv(sensor: Sensor, rgb: Array) -> Array:
    """CIE 1976 u', v' (…, 2); of black, which has none, those of white."""
    X, Y, Z = np.moveaxis(
        np.where((rgb > 0).any(axis=-1, keepdims=True), sensor.xyz(rgb), sensor.light.white), -1, 0
    )
    return np.stack([4 * X, 9 * Y], axis=-1) / (X + 15 * Y + 3 * Z)[..., None]


def _turn(sensor: Sensor, rgb: Array, other: Array) -> Array:
    """Degrees (…) between two colours, seen from white."""
    first, second = (_uv(sensor, one) - _uv(sensor, WHITE) for one in (rgb, other))
    angles = (np.arctan2(one[..., 1], one[..., 0]) for one in (first, second))
    return np.abs((np.degrees(next(angles) - next(angles)) + 180) % 360 - 180)


def _chroma(sensor: Sensor, rgb: Array) -> float:
    return float(np.linalg.norm(rgb_to_lab(sensor, rgb)[..., 1:]))


def _not_green(rgb: Array) -> float:
    """How far the greenest of colours (n, 3) is from having more green than red and blue; below 0 it has."""
    return float((np.maximum(rgb[:, 0], rgb[:, 2]) - rgb[:, 1]).min())
