"""Atlas entries as spectra of the model: measured shape, exact colour, other lights (docs/mathematics.md, 6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.fit.objective import BALANCED, Weights, objective
from uplift.fit.solve import solve
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap

PASSES = 32


@dataclass(frozen=True, eq=False)
class FittedEntries:
    """Atlas entries as spectra of the model.

    Parameters
    ----------
    rgb, measured : (E, 3) linear RGB and (E, N) reflectances.
    multipliers : (E, C).
    error : (E,) ΔE00 between measurement and model under the reference light.
    """

    rgb: Array
    measured: Array
    multipliers: Array
    error: Array


def fit_entries(
    model: Model,
    forward: ForwardMap,
    measured: Array,
    rgb: Array,
    lights: Sequence[Light],
    reference: Light,
    tolerance: float,
    weights: Weights = BALANCED,
) -> FittedEntries:
    """Fit measured reflectances (E, N) on the sensor's wavelengths.

    ``rgb`` (E, 3) is met to ``tolerance``; the spectrum and its colours under ``lights`` as well as they can be.
    """
    from scipy.optimize import (
        least_squares,
    )  # by MINPACK, an entry at a time: 3 ms each, and nothing to compile

    goal = objective(model, forward.basis, lights, weights)
    start = np.zeros((len(measured), model.count))
    for row, spectrum in enumerate(measured):
        found = least_squares(
            goal.residuals, start[row], lambda p, _: goal.jacobian(p), method="lm", args=(spectrum,)
        )
        start[row] = found.x
    multipliers = solve(model, forward, start, rgb, tolerance=tolerance, passes=PASSES).multipliers
    spectra = np.asarray(model.squash(multipliers @ forward.basis.T))
    return FittedEntries(rgb, measured, multipliers, delta_e_spectra(reference, spectra, measured))
