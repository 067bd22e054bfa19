"""The project's own choice: wavelengths, weights and prefiltered lights fitted to what is rendered."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.errors import OptionError
from uplift.scene.wavelengths import uniform
from uplift.scene.wavelengths.local_fit import polish, polish_weights, problem
from uplift.scene.wavelengths.sampling import Sampling, evaluate
from uplift.scene.wavelengths.setup import RenderSetup

RANGES = ((400.0, 700.0), (410.0, 680.0))
"""Where the starts are spread (nm): least squares ends in the nearest minimum, so it starts twice."""
MAX_FITTED_PAIRS = 1600
"""Materials times lights that are fitted; of more, every so-many-th. All are judged."""


def optimise(setting: RenderSetup, count: int) -> Sampling:
    """The ``count`` wavelengths, weights and powers of least ΔE00 that were found; all weights at least 0.

    Starts are evenly spaced and prefiltered. The same input gives the same answer.
    """
    fitted = problem(_thinned(setting))
    starts = (uniform.prefiltered(fitted.setting, uniform.midpoints(count, *span)) for span in RANGES)
    found = [_scaled(fitted.setting, polish(fitted, start).ordered()) for start in starts]
    return min(found, key=lambda sampling: evaluate(setting, sampling).mean)


def fit_at(setting: RenderSetup, wavelengths: ArrayLike) -> Sampling:
    """Weights and powers of least ΔE00 for given wavelengths (n,) nm, distinct and within the setting's.

    Raises
    ------
    OptionError : none of them, one outside, one named twice.
    """
    nm = np.sort(np.asarray(wavelengths, dtype=float))
    first, last = setting.wavelengths[[0, -1]]
    if nm.ndim != 1 or not len(nm) or np.any(np.diff(nm) <= 0) or not first <= nm[0] <= nm[-1] <= last:
        raise OptionError(
            "the wavelengths are not distinct ones of the spectrum",
            hint=f"give each once, from {first:g} to {last:g} nm",
        )
    fitted = problem(_thinned(setting))
    return _scaled(fitted.setting, polish_weights(fitted, uniform.prefiltered(fitted.setting, nm)))


def fit_uniform(setting: RenderSetup, count: int) -> Sampling:
    """Evenly spaced wavelengths, weights and powers fitted."""
    return fit_at(setting, uniform.midpoints(count))


def _scaled(setting: RenderSetup, sampling: Sampling) -> Sampling:
    """The same radiances, the powers as near to the lights themselves as may be.

    Only the product of weight and power is seen, so a factor may pass from one to the other at each wavelength.
    """
    nearby = uniform.prefiltered(setting, sampling.wavelengths).powers.sum(axis=0)
    fitted = sampling.powers.sum(axis=0)
    factor = np.where(fitted > 0, nearby / np.where(fitted > 0, fitted, 1), 1.0)
    return replace(sampling, to_xyz=sampling.to_xyz / factor[:, None], powers=sampling.powers * factor)


def _thinned(setting: RenderSetup) -> RenderSetup:
    """As many materials as can be fitted in seconds, and the perfect reflector: a white wall stays white."""
    most = max(MAX_FITTED_PAIRS // len(setting.lights), 32)
    count = len(setting.reflectances)
    kept = setting.only(np.unique(np.linspace(0, count - 1, most).astype(int)))
    return replace(kept, reflectances=np.vstack([kept.reflectances, np.ones(len(setting.wavelengths))]))
