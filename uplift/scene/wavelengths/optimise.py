"""Wavelengths, weights and prefiltered lights fitted to the materials and lights of a setup."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.errors import OptionError
from uplift.scene.wavelengths.local_fit import FitProblem, local_fit
from uplift.scene.wavelengths.sampling import Sampling, evaluate
from uplift.scene.wavelengths.setup import RenderSetup
from uplift.scene.wavelengths.uniform import midpoints, prefiltered

START_RANGES = ((400.0, 700.0), (410.0, 680.0))
"""Ranges in nm of the two starting points: least squares ends in the nearest local minimum."""
MAX_FITTED_PAIRS = 1600
"""Most pairs of material and light that are fitted. Materials are thinned evenly; the errors cover all of them."""
MIN_FITTED = 32
"""Fewest materials that are fitted, however many lights there are."""


def optimise(setup: RenderSetup, count: int) -> Sampling:
    """Fit ``count`` wavelengths, their weights and powers, all at least 0, for the least mean ΔE00.

    The fit starts from evenly spaced, prefiltered wavelengths, and is deterministic.
    """
    problem = FitProblem(_thinned(setup))
    starts = (prefiltered(problem.setup, midpoints(count, *span)) for span in START_RANGES)
    fits = [_with_nearby_powers(problem.setup, local_fit(problem, start).ordered()) for start in starts]
    return min(fits, key=lambda sampling: evaluate(setup, sampling).mean)


def fit_at(setup: RenderSetup, wavelengths: ArrayLike) -> Sampling:
    """Fit weights and powers at given wavelengths (n,) nm. Raises `OptionError`."""
    nm = np.sort(np.asarray(wavelengths, dtype=float))
    first, last = setup.wavelengths[[0, -1]]
    if nm.ndim != 1 or not len(nm) or np.any(np.diff(nm) <= 0) or not first <= nm[0] <= nm[-1] <= last:
        raise OptionError(
            f"wavelengths must be distinct and within [{first:g}, {last:g}] nm",
            code="invalid-wavelengths",
            hint="give each wavelength once",
        )
    problem = FitProblem(_thinned(setup))
    fit = local_fit(problem, prefiltered(problem.setup, nm), fix_wavelengths=True)
    return _with_nearby_powers(problem.setup, fit)


def fit_uniform(setup: RenderSetup, count: int) -> Sampling:
    """Fit weights and powers at evenly spaced wavelengths."""
    return fit_at(setup, midpoints(count))


def _with_nearby_powers(setup: RenderSetup, sampling: Sampling) -> Sampling:
    """Move a factor from weights to powers at each wavelength so that the powers resemble the lights.

    Colours depend only on the product of weight and power.
    """
    nearby = prefiltered(setup, sampling.wavelengths).powers.sum(axis=0)
    fitted = sampling.powers.sum(axis=0)
    factor = np.where(fitted > 0, nearby / np.where(fitted > 0, fitted, 1), 1.0)
    return replace(sampling, to_xyz=sampling.to_xyz / factor[:, None], powers=sampling.powers * factor)


def _thinned(setup: RenderSetup) -> RenderSetup:
    """Thin the materials to `MAX_FITTED_PAIRS` and append the perfect reflector, which keeps white neutral."""
    limit = max(MAX_FITTED_PAIRS // len(setup.lights), MIN_FITTED)
    thinned = setup.only(np.unique(np.linspace(0, len(setup.reflectances) - 1, limit).astype(int)))
    return replace(thinned, reflectances=np.vstack([thinned.reflectances, np.ones(len(setup.wavelengths))]))
