"""Local least-squares fit of wavelengths, weights and powers to the colours of a setup."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import least_squares

from uplift.common.arrays import Array
from uplift.common.threads import single_threaded_blas
from uplift.scene.wavelengths.metric import delta_e_factors
from uplift.scene.wavelengths.sampling import Sampling
from uplift.scene.wavelengths.setup import RenderSetup

MAX_EVALUATIONS = 60
"""More evaluations gain nothing on materials outside the fit."""


@dataclass(frozen=True, eq=False)
class FitProblem:
    """Least-squares problem over a vector of wavelengths (n,), weights (n, 3) and powers (K, n), in this order."""

    setup: RenderSetup

    @cached_property
    def factors(self) -> Array:
        """Factors (K, M, 3, 3) of ΔE00, see `delta_e_factors`."""
        return delta_e_factors(self.setup)

    @staticmethod
    def pack(sampling: Sampling) -> Array:
        """Concatenate the unknowns of a sampling."""
        return np.concatenate([sampling.wavelengths, sampling.to_xyz.ravel(), sampling.powers.ravel()])

    def unpack(self, unknowns: Array) -> Sampling:
        """Invert `pack`."""
        lights = len(self.setup.lights)
        count = len(unknowns) // (4 + lights)
        nm, weights, powers = np.split(unknowns, [count, 4 * count])
        return Sampling(nm, weights.reshape(count, 3), self.setup.lights, powers.reshape(lights, count))

    def residuals(self, unknowns: Array) -> Array:
        """Differences (K · M · 3,) from the colours of the full grid; the length of each triple is ΔE00."""
        sampling = self.unpack(unknowns)
        difference = sampling.xyz(self.setup.curves(sampling.wavelengths)) - self.setup.xyz
        return np.einsum("kmij,kmj->kmi", self.factors, difference).ravel()

    def jacobian(self, unknowns: Array) -> Array:
        """Derivative (K · M · 3, (4 + K) n) of the residuals."""
        sampling = self.unpack(unknowns)
        values, slopes = (self.setup.curves(sampling.wavelengths, order) for order in (0, 1))
        lights, materials, count = len(sampling.lights), len(values), len(sampling)
        weighted = np.einsum("kmij,nj->kmin", self.factors, sampling.to_xyz)
        radiance = sampling.powers[:, None, :] * values
        by_powers = np.zeros((lights, materials, 3, lights, count))
        for light in range(lights):
            by_powers[light, :, :, light] = weighted[light] * values[:, None, :]
        blocks = (
            weighted * (sampling.powers[:, None, :] * slopes)[:, :, None, :],
            radiance[:, :, None, :, None] * self.factors[:, :, :, None, :],
            by_powers,
        )
        height = lights * materials * 3
        return np.concatenate([block.reshape(height, -1) for block in blocks], axis=1)


def local_fit(problem: FitProblem, start: Sampling, *, fix_wavelengths: bool = False) -> Sampling:
    """Find the local minimum nearest to ``start`` with weights and powers of at least 0."""
    nm = problem.setup.wavelengths
    count, fixed = len(start), len(start) if fix_wavelengths else 0
    unknowns = problem.pack(start)
    others = len(unknowns) - count
    low = np.concatenate([np.full(count, nm[0]), np.zeros(others)])
    high = np.concatenate([np.full(count, nm[-1]), np.full(others, np.inf)])
    unknowns = np.clip(unknowns, low, high)

    def with_fixed(free: Array) -> Array:
        return np.concatenate([unknowns[:fixed], free])

    with single_threaded_blas():
        solution = least_squares(
            lambda free: problem.residuals(with_fixed(free)),
            unknowns[fixed:],
            lambda free: problem.jacobian(with_fixed(free))[:, fixed:],
            bounds=(low[fixed:], high[fixed:]),
            x_scale="jac",
            max_nfev=MAX_EVALUATIONS,
        )
    return problem.unpack(with_fixed(solution.x))
