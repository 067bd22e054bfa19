"""Painters' expectations of a mixture, as five measurable criteria (Fishkin 1983, section 10.4).

The thesis requires tints to maintain chromaticity, too. White, however, moves every chromaticity towards its own. A
tint can only keep its hue, the direction from white in the CIE 1976 u'v' diagram. A shade can keep its chromaticity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb, rgb_to_lab
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.mixing.theories import Mixer

BLACK, WHITE = np.zeros(3), np.ones(3)
# Blue and orange, red and green, yellow and purple, as saturated linear RGB.
COMPLEMENTS = (((0, 0, 1), (1, 0.5, 0)), ((1, 0, 0), (0, 1, 0)), ((1, 1, 0), (1, 0, 1)))
BLUE_YELLOW = np.array([[0.0, 0, 1], [1.0, 1, 0]])
SHARES = np.array([(0.75, 0.25), (0.5, 0.5), (0.25, 0.75)])  # proportions of shades, tints and greens


@dataclass(frozen=True)
class Criterion:
    """A criterion in words, the measured quantity, and its largest value that passes."""

    title: str
    measure: str
    limit: float


# All criteria, in the order of `evaluate`.
CRITERIA = (
    Criterion("mixed with itself: no change", "worst ΔE00", 0.1),
    Criterion("with black: chromaticity kept", "worst Δu'v'", 0.005),
    Criterion("with black: darker", "largest change of L*", 0.0),
    Criterion("with white: hue kept", "worst turn, degrees", 3.0),
    Criterion("with white: lighter", "largest fall of L*", 0.0),
    Criterion("with its complement: grey", "worst C*ab", 10.0),
    Criterion("blue and yellow: green", "max(R, B) − G at best", -0.01),
)


def evaluate(mixer: Mixer, sensor: Sensor, colours: Array) -> tuple[float, ...]:
    """Measure a mixing model by every criterion, the first five with linear RGB (n, 3) without greys."""
    itself = np.array([mixer.mix(np.stack([one, one]), np.ones(2)) for one in colours])
    shades, tints = (
        np.array([mixer.mix(np.stack([one, other]), 2 * SHARES) for one in colours]) for other in (BLACK, WHITE)
    )
    neutral = [mixer.mix(np.array(pair, dtype=float), np.ones(2)) for pair in COMPLEMENTS]
    greens = mixer.mix(BLUE_YELLOW, 2 * SHARES)
    lightness = rgb_to_lab(sensor, colours)[:, None, 0]
    return (
        float(delta_e_rgb(sensor, colours, itself).max()),
        float(np.linalg.norm(_uv(sensor, shades) - _uv(sensor, colours)[:, None], axis=-1).max()),
        float((rgb_to_lab(sensor, shades)[..., 0] - lightness).max()),
        float(hue_difference(sensor, tints, colours[:, None]).max()),
        float((lightness - rgb_to_lab(sensor, tints)[..., 0]).max()),
        max(float(np.linalg.norm(rgb_to_lab(sensor, one)[..., 1:])) for one in neutral),
        float((np.maximum(greens[:, 0], greens[:, 2]) - greens[:, 1]).min()),
    )


def _uv(sensor: Sensor, rgb: Array) -> Array:
    """Return CIE 1976 u', v' (…, 2). Black, which has none, gets those of white."""
    X, Y, Z = np.moveaxis(np.where((rgb > 0).any(axis=-1, keepdims=True), sensor.xyz(rgb), sensor.light.white), -1, 0)
    return np.stack([4 * X, 9 * Y], axis=-1) / (X + 15 * Y + 3 * Z)[..., None]


def hue_difference(sensor: Sensor, rgb: Array, other: Array) -> Array:
    """Return the angle (…) in degrees between two colours around white in u'v'."""
    first, second = (_uv(sensor, one) - _uv(sensor, WHITE) for one in (rgb, other))
    turn = np.arctan2(first[..., 1], first[..., 0]) - np.arctan2(second[..., 1], second[..., 0])
    return np.abs((np.degrees(turn) + 180) % 360 - 180)
