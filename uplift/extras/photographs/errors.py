"""Standard errors of answers to several photographs, learnt from left-out materials
that are photographed under the same lights with the same noise.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.extras.photographs.answers import Photographs
from uplift.lookup.errors_under_lights import (
    Evidence,
    LightErrors,
    errors_from,
    evidence,
)

SEED = 1
"""Of the noise, which is the same in each call."""


def light_errors(photographs: Photographs, light: Light) -> LightErrors:
    """Learn the standard errors under a light of answers to several photographs.

    Parameters
    ----------
    photographs : Photographs
        Made by `prepare`.
    light : Light
        Light under which answers and measurements are compared.

    Returns
    -------
    LightErrors
        Function from linear RGB (n, 3) in [0, 1] to the ΔE00 (n, 2) that 68 % and 95 %
        of measurements stay within.
    """
    return errors_from(photographs.cube.data, light, photographed(photographs))


@lru_cache(maxsize=2)
def photographed(photographs: Photographs) -> Evidence:
    """Return the left-out materials, each answered from photographs of it by a cube
    that does not know it.
    """
    data = photographs.cube.data
    known = evidence(data)
    noise = photographs.noise
    measured = np.asarray(known.measured, dtype=float)
    random = np.random.default_rng(SEED)

    def noisy(values: Array) -> Array:
        normal = random.standard_normal(values.shape)
        return values + np.sqrt(noise.variance(values)) * normal

    rgb = data.sensor.rgb(measured)
    observed = np.clip(noisy(rgb), 0, 1)
    # The answer to another colour: the spectrum changes least.
    change = (observed - rgb) @ np.linalg.pinv(data.sensor.matrix).T
    covariance = photographs.metamers.left_out_covariance(known.family)
    answers = photographs.answer(
        observed,
        noisy(measured @ photographs.matrix.T),
        np.clip(known.left_out + change, 0, 1),
        directions=photographs.directions(covariance),
    )
    kept = np.clip(known.kept + change, 0, 1)
    return replace(known, left_out=answers.spectra, kept=kept)
