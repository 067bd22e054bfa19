"""Answers of other methods at the colours of measured spectra: a cube without an atlas, and Jakob & Hanika 2019."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import on_range
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lookup import load
from uplift.lookup.refine import refine_to_rgb
from uplift.models import Sigmoid, evaluate
from uplift.report.fidelity import EntryErrors

WITHOUT_ATLAS, JAKOB_HANIKA = "without atlas", "Jakob & Hanika"


@dataclass(frozen=True, eq=False)
class Alternative:
    """Answers of another method at the colours of E entries."""

    name: str  # Name of the method
    answer: Array  # (E, N) Reflectances; NaN for colours that the method does not answer
    delta_e: Array  # (E, L) ΔE00 to the measured spectra under L lights; NaN likewise

    @property
    def mean(self) -> Array:
        """Return the mean ΔE00 of the answers under each light, shape (L,); NaN without any."""
        return self._statistic(np.mean)

    @property
    def largest(self) -> Array:
        """Return the largest ΔE00 of the answers under each light, shape (L,); NaN without any."""
        return self._statistic(np.max)

    def _statistic(self, function: Callable[..., Array]) -> Array:
        known = self.delta_e[~np.isnan(self.delta_e).any(axis=1)]
        return function(known, axis=0) if len(known) else np.full(self.delta_e.shape[1], np.nan)


def find_alternatives(data: CubeData, errors: EntryErrors, lights: tuple[Sensor, ...]) -> tuple[Alternative, ...]:
    """Compute the answers of other methods at the colours of entries."""
    answers = {
        WITHOUT_ATLAS: _without_atlas(errors.target, data.sensor),
        JAKOB_HANIKA: _sigmoid(data, errors.rgb),
    }
    return tuple(Alternative(name, answer, _delta_e(lights, answer, errors.target)) for name, answer in answers.items())


def _without_atlas(target: Array, assessed: Sensor) -> Array:
    """Reflectance (E, N) of the packaged cube at the colours of measured spectra (E, N)."""
    cube = load()
    rgb = on_range(cube.data.sensor, *assessed.range).rgb(target)
    inside = cube.data.sensor.contains(rgb)
    answer = np.full_like(target, np.nan)
    answer[inside] = cube.reflectance(np.clip(rgb[inside], 0, 1), assessed.wavelengths)
    return answer


def _sigmoid(data: CubeData, rgb: Array) -> Array:
    """Reflectance (E, N) of the sigmoid with exactly the colours (E, 3), from grey on."""
    model = Sigmoid()
    multipliers = refine_to_rgb(data, model, np.zeros((len(rgb), model.count)), rgb)
    answer = evaluate(model, multipliers, data.sensor.wavelengths)
    distance = np.abs(data.sensor.rgb(answer) - rgb).max(axis=1)
    return np.where((distance <= data.threshold)[:, None], answer, np.nan)


def _delta_e(lights: tuple[Sensor, ...], answer: Array, target: Array) -> Array:
    known = ~np.isnan(answer).any(axis=1)
    errors = np.full((len(target), len(lights)), np.nan)
    for column, sensor in enumerate(lights):
        errors[known, column] = delta_e_spectra(sensor.light, answer[known], target[known])
    return errors
