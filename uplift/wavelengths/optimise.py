"""The project's own choice: wavelengths, weights and prefiltered lights fitted to what is rendered."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uplift.sensor import Array
from uplift.wavelengths import plain
from uplift.wavelengths.polish import Problem, polish, problem
from uplift.wavelengths.sampling import Sampling, judge
from uplift.wavelengths.setting import Setting

RANGES = ((400.0, 700.0), (410.0, 680.0))
"""Where the starts are spread (nm): least squares ends in the nearest minimum, so it starts twice."""
PAIRS = 2400
"""Materials times lights that are fitted; of more, every so-many-th. All are judged."""


def optimised(setting: Setting, count: int) -> Sampling:
    """The ``count`` wavelengths, weights and powers of least ΔE00 that were found; all weights at least 0.

    Starts are evenly spaced and prefiltered. The same input gives the same answer.
    """
    fitted = problem(_thinned(setting))
    return min(
        (_from(fitted, plain.even(count, *span)) for span in RANGES),
        key=lambda sampling: judge(setting, sampling).mean,
    )


def _from(fitted: Problem, start: Array) -> Sampling:
    found = polish(fitted, plain.prefiltered(fitted.setting, start))
    return _scaled(fitted.setting, found).ordered()


def _scaled(setting: Setting, sampling: Sampling) -> Sampling:
    """The same radiances, the powers as near to the lights themselves as may be.

    Only the product of weight and power is seen, so a factor may pass from one to the other at each wavelength.
    """
    order = np.argsort(sampling.wavelengths)
    nearby = np.empty(len(sampling))
    nearby[order] = plain.prefiltered(setting, sampling.wavelengths[order]).powers.sum(axis=0)
    fitted = sampling.powers.sum(axis=0)
    factor = np.where(fitted > 0, nearby / np.where(fitted > 0, fitted, 1), 1.0)
    return replace(sampling, to_xyz=sampling.to_xyz / factor[:, None], powers=sampling.powers * factor)


def _thinned(setting: Setting) -> Setting:
    """As many materials as can be fitted in seconds, and the perfect reflector: a white wall stays white."""
    most = max(PAIRS // len(setting.lights), 32)
    count = len(setting.reflectances)
    kept = setting.only(np.unique(np.linspace(0, count - 1, most).astype(int)))
    return replace(kept, reflectances=np.vstack([kept.reflectances, np.ones(len(setting.wavelengths))]))
