"""Colours a little beside those asked: how far the answers move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.lookup import MODES, Cube

COLOURS = 4096
CONTINUOUS_MODES = tuple(mode for mode in MODES if mode != "nearest")
"""Modes whose answers move as the question does; the nearest node jumps."""
STEPS = {"1/255": 1.0, "1/1023": 255 / 1023}
"""A code of 8 and of 10 bits, in codes of 8."""
ROUNDING = "1e-7"
FLOAT = 1e-7
"""Rounding of a float32, linear RGB."""


@dataclass(frozen=True)
class Perturbation:
    """Answers of ``mode`` to colours moved by ``step``: mean and most over the colours.

    rms and largest change over wavelength; ΔE00 under a light, and under the build illuminant, of which the
    question itself is the cause.
    """

    mode: str
    step: str
    rms_mean: float
    rms_most: float
    largest: float
    light_mean: float
    light_most: float
    own_mean: float
    own_most: float


def perturb(cube: Cube, light: Light, count: int = COLOURS) -> list[Perturbation]:
    """Random colours, evenly over the codes of the cube's space, each moved by every step in a random direction.

    Every channel goes up or down by the whole step.
    """
    rng = np.random.default_rng(5)
    codes = rng.uniform(1, 254, (count, 3))
    signs = rng.choice([-1.0, 1.0], (count, 3))
    asked = cube.decode(codes)
    moved = {name: cube.decode(codes + step * signs) for name, step in STEPS.items()}
    moved[ROUNDING] = np.clip(asked + FLOAT * signs, 0, 1)
    return [
        _move(cube, light, mode, name, asked, beside)
        for mode in CONTINUOUS_MODES
        for name, beside in moved.items()
    ]


def _move(cube: Cube, light: Light, mode: str, step: str, asked: Array, beside: Array) -> Perturbation:
    before, after = (cube.reflectance(rgb, mode=mode) for rgb in (asked, beside))
    rms = np.sqrt(((after - before) ** 2).mean(axis=1))
    seen = delta_e_spectra(light, before, after)
    own = delta_e_spectra(cube.data.sensor.light, before, after)
    pairs = (float(value) for values in (seen, own) for value in (values.mean(), values.max()))
    return Perturbation(
        mode, step, float(rms.mean()), float(rms.max()), float(np.abs(after - before).max()), *pairs
    )
