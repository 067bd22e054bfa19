"""Painters' expectations of a mixture, as five measurable criteria.

Fishkin 1983, section 10.4, requires tints to maintain chromaticity, too. White, however, moves every chromaticity
towards its own. A tint can only keep its hue, the direction from white in the CIE 1976 u'v' diagram. A shade can keep
its chromaticity.
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
"""Blue and orange, red and green, yellow and purple, as saturated linear RGB."""
BLUE, YELLOW = np.array([0.0, 0, 1]), np.array([1.0, 1, 0])
SHARES = np.array([(0.75, 0.25), (0.5, 0.5), (0.25, 0.75)])
"""Proportions of shades, tints and greens."""


@dataclass(frozen=True)
class Criterion:
    """A criterion.

    Parameters
    ----------
    title : str
        The criterion in words.
    measure : str
        Name of the measured quantity.
    limit : float
        Largest value that passes.
    """

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
"""All criteria, in the order of `evaluate`."""


@dataclass(frozen=True)
class CriterionResult:
    """Measured value of a criterion.

    Parameters
    ----------
    criterion : Criterion
        The criterion.
    value : float
        Its measure.
    """

    criterion: Criterion
    value: float

    @property
    def passed(self) -> bool:
        """Whether the value is within the limit."""
        return self.value <= self.criterion.limit


def evaluate(mixer: Mixer, sensor: Sensor, colours: Array) -> tuple[CriterionResult, ...]:
    """Measure how well a mixing model meets the criteria.

    Parameters
    ----------
    mixer : Mixer
        The mixing model.
    sensor : Sensor
        The sensor of its RGB.
    colours : ndarray of shape (n, 3)
        Linear RGB without greys, for the first five criteria.

    Returns
    -------
    tuple of CriterionResult
        One per criterion.
    """
    shades, tints = (_mix_with(mixer, colours, other) for other in (BLACK, WHITE))
    lightness = rgb_to_lab(sensor, colours)[:, None, 0]
    values = (
        float(delta_e_rgb(sensor, colours, _mix_with_itself(mixer, colours)).max()),
        float(np.linalg.norm(_uv(sensor, shades) - _uv(sensor, colours)[:, None], axis=-1).max()),
        float((rgb_to_lab(sensor, shades)[..., 0] - lightness).max()),
        float(_hue_difference(sensor, tints, colours[:, None]).max()),
        float((lightness - rgb_to_lab(sensor, tints)[..., 0]).max()),
        max(_chroma(sensor, _mix_equally(mixer, *pair)) for pair in COMPLEMENTS),
        _green_deficit(mixer.mix(np.stack([BLUE, YELLOW]), 2 * SHARES)),
    )
    return tuple(CriterionResult(criterion, value) for criterion, value in zip(CRITERIA, values, strict=True))


def _mix_with_itself(mixer: Mixer, colours: Array) -> Array:
    return np.array([mixer.mix(np.stack([one, one]), np.ones(2)) for one in colours])


def _mix_with(mixer: Mixer, colours: Array, other: Array) -> Array:
    """Return mixtures (n, shares, 3) of each colour with another."""
    return np.array([mixer.mix(np.stack([one, other]), 2 * SHARES) for one in colours])


def _mix_equally(mixer: Mixer, first: tuple[float, ...], second: tuple[float, ...]) -> Array:
    return mixer.mix(np.array([first, second], dtype=float), np.ones(2))


def _uv(sensor: Sensor, rgb: Array) -> Array:
    """Return CIE 1976 u', v' (…, 2). Black, which has none, gets those of white."""
    X, Y, Z = np.moveaxis(np.where((rgb > 0).any(axis=-1, keepdims=True), sensor.xyz(rgb), sensor.light.white), -1, 0)
    return np.stack([4 * X, 9 * Y], axis=-1) / (X + 15 * Y + 3 * Z)[..., None]


def _hue_difference(sensor: Sensor, rgb: Array, other: Array) -> Array:
    """Return the angle (…) in degrees between two colours around white in u'v'."""
    first, second = (_uv(sensor, one) - _uv(sensor, WHITE) for one in (rgb, other))
    angles = (np.arctan2(one[..., 1], one[..., 0]) for one in (first, second))
    return np.abs((np.degrees(next(angles) - next(angles)) + 180) % 360 - 180)


def _chroma(sensor: Sensor, rgb: Array) -> float:
    return float(np.linalg.norm(rgb_to_lab(sensor, rgb)[..., 1:]))


def _green_deficit(rgb: Array) -> float:
    """Return max(R, B) − G of the greenest of colours (n, 3); it is negative for a green."""
    return float((np.maximum(rgb[:, 0], rgb[:, 2]) - rgb[:, 1]).min())
