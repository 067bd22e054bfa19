"""Wavelengths, weights and powers together, moved until the colours of a setting fit as well as they can."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from uplift.common.arrays import Array
from uplift.common.threads import single_threaded_blas
from uplift.scene.wavelengths import metric
from uplift.scene.wavelengths.sampling import Sampling
from uplift.scene.wavelengths.setup import RenderSetup

STEPS = 60
"""Steps of the least squares; more gain nothing on materials that were not fitted."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Least squares over wavelengths (n,), weights (n, 3) and powers (K, n), laid out in this order.

    Parameters
    ----------
    setting : materials and lights.
    rows : (K, M, 3, 3) from XYZ to ΔE00, see `metric.rows`.
    """

    setting: RenderSetup
    rows: Array

    def unpack(self, unknowns: Array) -> Sampling:
        lights = len(self.setting.lights)
        count = len(unknowns) // (4 + lights)
        nm, weights, powers = np.split(unknowns, [count, 4 * count])
        return Sampling(nm, weights.reshape(count, 3), self.setting.lights, powers.reshape(lights, count))

    def residuals(self, unknowns: Array) -> Array:
        """(K · M · 3,) differences from the full sum, their length ΔE00."""
        sampling = self.unpack(unknowns)
        apart = sampling.xyz(self.setting.curves(sampling.wavelengths)) - self.setting.xyz
        return np.einsum("kmij,kmj->kmi", self.rows, apart).ravel()

    def jacobian(self, unknowns: Array) -> Array:
        """(K · M · 3, (4 + K) n) derivative of the residuals."""
        sampling = self.unpack(unknowns)
        here, slope = (self.setting.curves(sampling.wavelengths, order) for order in (0, 1))
        lights, materials, count = len(sampling.lights), len(here), len(sampling)
        weighted = np.einsum("kmij,nj->kmin", self.rows, sampling.to_xyz)
        radiance = sampling.powers[:, None, :] * here
        by_powers = np.zeros((lights, materials, 3, lights, count))
        for light in range(lights):
            by_powers[light, :, :, light] = weighted[light] * here[:, None, :]
        parts = (
            weighted * (sampling.powers[:, None, :] * slope)[:, :, None, :],
            radiance[:, :, None, :, None] * self.rows[:, :, :, None, :],
            by_powers,
        )
        height = lights * materials * 3
        return np.concatenate([part.reshape(height, -1) for part in parts], axis=1)


def problem(setting: RenderSetup) -> Problem:
    """The least squares of a setting."""
    return Problem(setting, metric.delta_e_factors(setting))


def polish(problem: Problem, start: Sampling) -> Sampling:
    """The nearest sampling to ``start`` that fits best, its weights and powers at least 0."""
    return _fit(problem, start, held=0)


def polish_weights(problem: Problem, start: Sampling) -> Sampling:
    """The same with the wavelengths kept."""
    return _fit(problem, start, held=len(start))


def _fit(problem: Problem, start: Sampling, held: int) -> Sampling:
    """Least squares over all unknowns but the first ``held``."""
    nm, count = problem.setting.wavelengths, len(start)
    unknowns = np.concatenate([start.wavelengths, start.to_xyz.ravel(), start.powers.ravel()])
    others = len(unknowns) - count
    low = np.concatenate([np.full(count, nm[0]), np.zeros(others)])
    high = np.concatenate([np.full(count, nm[-1]), np.full(others, np.inf)])
    unknowns = np.clip(unknowns, low, high)

    def whole(free: Array) -> Array:
        return np.concatenate([unknowns[:held], free])

    with single_threaded_blas():
        found = least_squares(
            lambda free: problem.residuals(whole(free)),
            unknowns[held:],
            lambda free: problem.jacobian(whole(free))[:, held:],
            bounds=(low[held:], high[held:]),
            x_scale="jac",
            max_nfev=STEPS,
        )
    return problem.unpack(whole(found.x))
