"""Sensitivity of answers to small changes of the query."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.lookup import MODES, Cube

COLOURS = 4096
CONTINUOUS_MODES = tuple(mode for mode in MODES if mode != "nearest")
"""Modes in which answers depend continuously on the query; the nearest node changes abruptly."""
CODE_STEPS = {"1/255": 1.0, "1/1023": 255 / 1023}
"""Steps of one code of 8 and of 10 bits, in 8-bit codes."""
ROUNDING, ROUNDING_STEP = "1e-7", 1e-7
"""Rounding of a float32, in linear RGB."""


@dataclass(frozen=True)
class Perturbation:
    """Changes of the answers of one mode to colours that moved by one step.

    ``_mean`` and ``_most`` are mean and maximum over the colours. The fields are the keys of the JSON output.

    Parameters
    ----------
    mode : str
        Lookup mode.
    step : str
        Name of the step.
    rms_mean, rms_most : float
        Change of the reflectance, rms over wavelength.
    largest : float
        Largest change of reflectance at any wavelength.
    light_mean, light_most : float
        ΔE00 under the light of the study.
    own_mean, own_most : float
        ΔE00 under the illuminant of the cube, which the change of the query itself causes.
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
    """Move random colours, uniform in 8-bit codes, by every step and compare the answers.

    Every channel moves up or down, at random, by the full step.
    """
    rng = np.random.default_rng(5)
    codes = rng.uniform(1, 254, (count, 3))
    signs = rng.choice([-1.0, 1.0], (count, 3))
    rgb = cube.decode(codes)
    moved = {name: cube.decode(codes + step * signs) for name, step in CODE_STEPS.items()}
    moved[ROUNDING] = np.clip(rgb + ROUNDING_STEP * signs, 0, 1)
    return [
        _compare(cube, light, mode, name, rgb, nearby) for mode in CONTINUOUS_MODES for name, nearby in moved.items()
    ]


def _compare(cube: Cube, light: Light, mode: str, step: str, rgb: Array, nearby: Array) -> Perturbation:
    before, after = (cube.reflectance(colours, mode=mode) for colours in (rgb, nearby))
    change = np.sqrt(((after - before) ** 2).mean(axis=1))
    under_light = delta_e_spectra(light, before, after)
    under_own = delta_e_spectra(cube.data.sensor.light, before, after)
    return Perturbation(
        mode,
        step,
        rms_mean=float(change.mean()),
        rms_most=float(change.max()),
        largest=float(np.abs(after - before).max()),
        light_mean=float(under_light.mean()),
        light_most=float(under_light.max()),
        own_mean=float(under_own.mean()),
        own_most=float(under_own.max()),
    )
