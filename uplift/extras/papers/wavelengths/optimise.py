"""Wavelengths, weights and prefiltered lights fitted to the materials and lights of a
setup, by least squares.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from uplift.colorimetry.delta_e import delta_e_2000_form, lab_jacobian
from uplift.common.arrays import Array, as_nm
from uplift.common.errors import OptionError
from uplift.common.machine import single_threaded_blas
from uplift.extras.papers.wavelengths.sampling import (
    RenderSetup,
    Sampling,
    evaluate,
    midpoints,
    ordered,
    prefiltered,
)

MIN_EIGENVALUE = 1e-3
"""Lower bound of the eigenvalues of the form; rounding may make them negative."""
MAX_EVALUATIONS = 60
"""More evaluations gain nothing on materials outside the fit."""
START_RANGES = ((400.0, 700.0), (410.0, 680.0))
"""Ranges in nm of the two starting points: least squares ends in the nearest local
minimum.
"""
MAX_FITTED_PAIRS = 1600
"""Most pairs of material and light that are fitted. Materials are thinned evenly; the
errors cover all of them.
"""
MIN_FITTED = 32
"""Fewest materials that are fitted, however many lights there are."""


@dataclass(frozen=True, eq=False)
class FitProblem:
    """Least-squares problem over a vector of wavelengths (n,), weights (n, 3) and
    powers (K, n), in this order.
    """

    setup: RenderSetup

    @cached_property
    def factors(self) -> Array:
        """Factors T (K, M, 3, 3) at every material and light: |T (XYZ' − XYZ)| ≈ ΔE00
        of close colours.
        """
        values, vectors = np.linalg.eigh(delta_e_2000_form(self.setup.lab))
        root = np.sqrt(np.maximum(values, MIN_EIGENVALUE))[..., None] * vectors.mT
        return root @ lab_jacobian(self.setup.xyz, self.setup.whites[:, None])

    @staticmethod
    def pack(sampling: Sampling) -> Array:
        """Concatenate the unknowns of a sampling."""
        return np.concatenate(
            [sampling.wavelengths, sampling.to_xyz.ravel(), sampling.powers.ravel()]
        )

    def unpack(self, unknowns: Array) -> Sampling:
        """Invert `pack`."""
        lights = self.setup.lights
        count = len(unknowns) // (4 + len(lights))
        nm, weights, powers = np.split(unknowns, [count, 4 * count])
        return Sampling(
            nm, weights.reshape(-1, 3), lights, powers.reshape(len(lights), -1)
        )

    def residuals(self, unknowns: Array) -> Array:
        """Differences (K · M · 3,) from the colours of the full grid; the length of
        each triple is ΔE00.
        """
        sampling = self.unpack(unknowns)
        difference = (
            sampling.xyz(self.setup.curves(sampling.wavelengths)) - self.setup.xyz
        )
        return np.einsum("kmij,kmj->kmi", self.factors, difference).ravel()

    def jacobian(self, unknowns: Array) -> Array:
        """Derivative (K · M · 3, (4 + K) n) of the residuals."""
        sampling = self.unpack(unknowns)
        values, slopes = (
            self.setup.curves(sampling.wavelengths, order) for order in (0, 1)
        )
        weighted = np.einsum("kmij,nj->kmin", self.factors, sampling.to_xyz)
        radiance = sampling.powers[:, None, :] * values
        blocks = (
            weighted * (sampling.powers[:, None, :] * slopes)[:, :, None, :],
            radiance[:, :, None, :, None] * self.factors[:, :, :, None, :],
            np.einsum(
                "kmin,mn,kl->kmiln", weighted, values, np.eye(len(sampling.lights))
            ),
        )
        return np.concatenate(
            [block.reshape(self.setup.xyz.size, -1) for block in blocks], axis=1
        )


def local_fit(
    problem: FitProblem, start: Sampling, *, fix_wavelengths: bool = False
) -> Sampling:
    """Find the local minimum nearest to ``start`` with weights and powers of at least
    0.
    """
    count = len(start)
    unknowns = problem.pack(start)
    low = np.zeros_like(unknowns)
    high = np.full_like(unknowns, np.inf)
    low[:count], high[:count] = problem.setup.wavelengths[[0, -1]]
    unknowns = np.clip(unknowns, low, high)
    fixed = count if fix_wavelengths else 0

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


def optimise(setup: RenderSetup, count: int) -> Sampling:
    """Fit ``count`` wavelengths, their weights and powers, all at least 0, for the
    least mean ΔE00.
    """
    problem = FitProblem(_thinned(setup))
    starts = (
        prefiltered(problem.setup, midpoints(count, *span)) for span in START_RANGES
    )
    fits = [
        _with_nearby_powers(problem.setup, ordered(local_fit(problem, start)))
        for start in starts
    ]
    return min(fits, key=lambda sampling: evaluate(setup, sampling).mean())


def fit_at(setup: RenderSetup, wavelengths: ArrayLike) -> Sampling:
    """Fit weights and powers at given wavelengths (n,) nm. Raises `OptionError`."""
    nm = np.sort(as_nm(wavelengths))
    first, last = setup.wavelengths[[0, -1]]
    if np.any(np.diff(nm) <= 0) or not first <= nm[0] <= nm[-1] <= last:
        text = f"wavelengths must be distinct and within [{first:g}, {last:g}] nm"
        raise OptionError(text, hint="give each wavelength once")
    problem = FitProblem(_thinned(setup))
    fit = local_fit(problem, prefiltered(problem.setup, nm), fix_wavelengths=True)
    return _with_nearby_powers(problem.setup, fit)


def _with_nearby_powers(setup: RenderSetup, sampling: Sampling) -> Sampling:
    """Move a factor from weights to powers at each wavelength so that the powers
    resemble the lights.

    Colours depend only on the product of weight and power.
    """
    nearby = prefiltered(setup, sampling.wavelengths).powers.sum(axis=0)
    fitted = sampling.powers.sum(axis=0)
    factor = np.where(fitted > 0, nearby / np.where(fitted > 0, fitted, 1), 1.0)
    return replace(
        sampling,
        to_xyz=sampling.to_xyz / factor[:, None],
        powers=sampling.powers * factor,
    )


def _thinned(setup: RenderSetup) -> RenderSetup:
    """Thin the materials to `MAX_FITTED_PAIRS` and append the perfect reflector, which
    keeps white neutral.
    """
    limit = max(MAX_FITTED_PAIRS // len(setup.lights), MIN_FITTED)
    thinned = setup.only(
        np.unique(np.linspace(0, len(setup.reflectances) - 1, limit).astype(int))
    )
    return replace(
        thinned,
        reflectances=np.vstack([thinned.reflectances, np.ones(len(setup.wavelengths))]),
    )
