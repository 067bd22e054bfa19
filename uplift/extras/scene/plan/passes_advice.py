"""How many passes of an RGB renderer would keep the colours of a scene within its
tolerance.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.arrays import Array
from uplift.extras.scene.passes.bands import PRESETS
from uplift.extras.scene.passes.choice import fit_bands, path_errors
from uplift.extras.scene.passes.materials import Materials, halves, library_materials

MIN_MATERIALS = 8
"""Fewest spectra that are divided into halves; of fewer, all are in both."""


@dataclass(frozen=True)
class PassesAdvice:
    """Passes of an RGB renderer that a scene needs.

    Parameters
    ----------
    count : int
        Fewest passes within the tolerance, or the most if there are none.
    error : float
        ΔE00 that the quantile of the scene stays within, of one to four reflections
        under the worst light.
    within : bool
        Whether this error is within the tolerance.
    """

    count: int
    error: float
    within: bool


def advise_passes(
    reflectances: Array,
    lights: Sequence[Illuminant],
    tolerance: float,
    quantile: float,
) -> PassesAdvice:
    """Find the fewest passes that keep products of reflectances (n, 81) under lights
    within a tolerance.

    The bands are those chosen for the library, with matrices for the lights of the
    scene: passes chosen for its materials err less.
    """
    distinct = np.unique(np.clip(reflectances, 0, 1), axis=0)
    known = library_materials().training
    if len(distinct) < MIN_MATERIALS:
        judging = distinct
    else:
        first, judging = halves(distinct)
        known = np.concatenate([known, first])
    materials = Materials(known, judging)
    advice = PassesAdvice(0, np.inf, within=False)
    for count, bands in PRESETS.items():
        fitted = fit_bands(bands, materials, lights)
        errors = path_errors(fitted, materials, lights)
        error = float(np.quantile(errors, quantile, axis=1).max())
        advice = PassesAdvice(count, error, error <= tolerance)
        if advice.within:
            break
    return advice
