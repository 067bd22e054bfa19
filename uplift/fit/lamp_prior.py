"""The light expected at a chromaticity: kriging of the deviations of lamps from the smoothest light.

Colours of surfaces are linear in the power of the light that falls on them, so the best prediction is the conditional
mean of the power. It is spiky near the chromaticities of lamps, and smooth far from them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.fit.emission import nearest_lights
from uplift.lattice.chromaticity import DENOMINATOR, chromaticity

LENGTH, NUGGET = 0.05, 0.3
"""Correlation length in u′v′, and variance of the deviations that a lamp shares with no other."""
SMOOTHEST_SHARE = 1e-3
"""Smallest power of an expected light, as a share of that of the smoothest light."""


@dataclass(frozen=True, eq=False)
class LampPrior:
    """Expected lights.

    Parameters
    ----------
    uv : ndarray, shape (L, 2)
        u′v′ of the lamps.
    weights : ndarray, shape (L, N)
        Weights of the kernel around each lamp.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.
    """

    uv: Array
    weights: Array
    radiometry: Array

    def __call__(self, uv: Array) -> Array:
        """Power (n, N), of unit X + 15 Y + 3 Z nearly, expected at u′v′ (n, 2)."""
        smooth = smoothest_lights(uv, self.radiometry)
        return np.maximum(smooth + covariance(uv, self.uv) @ self.weights, SMOOTHEST_SHARE * smooth)


def fit_lamp_prior(power: Array, radiometry: Array) -> tuple[LampPrior, Array]:
    """Fit the prior to lamps.

    Parameters
    ----------
    power : ndarray, shape (L, N)
        Power of the lamps, of any scale.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.

    Returns
    -------
    prior : LampPrior
        Expected lights.
    left_out : ndarray, shape (L, N)
        Light expected at the chromaticity of each lamp without the lamp, exact in chromaticity.
    """
    power = power / (power @ radiometry @ DENOMINATOR)[:, None]
    uv = chromaticity(power @ radiometry)
    smooth = smoothest_lights(uv, radiometry)
    inverse = np.linalg.inv(covariance(uv, uv) + NUGGET * np.eye(len(uv)))
    weights = inverse @ (power - smooth)
    expected = power - weights / np.diag(inverse)[:, None]
    left_out = nearest_lights(np.maximum(expected, SMOOTHEST_SHARE * smooth), uv, radiometry)
    return LampPrior(uv, weights, radiometry), left_out


def smoothest_lights(uv: Array, radiometry: Array) -> Array:
    """Return the lights (n, N) of chromaticities (n, 2) that differ least from the equal-energy light."""
    return nearest_lights(np.ones((len(uv), len(radiometry))), uv, radiometry)


def covariance(first: Array, second: Array) -> Array:
    """Covariance (n, m) of the deviations at u′v′ (n, 2) and (m, 2)."""
    distance = np.linalg.norm(first[:, None] - second, axis=-1)
    return np.exp(distance / -LENGTH)
