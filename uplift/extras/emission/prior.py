"""The light expected at a chromaticity: kriging of the deviations of lamps from the
smoothest light.
"""

# Colours of surfaces are linear in the power of the light that falls on them, so the
# best prediction is the conditional mean of the power. It is spiky near the
# chromaticities of lamps, and smooth far from them.

from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.arrays import Array
from uplift.extras.emission.fit import nearest_lights
from uplift.extras.emission.lattice import chromaticity, unit_power

LENGTHS = (0.01, 0.02, 0.04, 0.08, 0.16, 0.32)
NUGGETS = (0.05, 0.1, 0.2, 0.4, 0.8, 1.6)
"""Candidates of `LampKernel`."""
EXACT_SHARE = 1e-2
"""Nugget of exact lamps, as a share of that of others."""
SMOOTHEST_SHARE = 1e-3
"""Smallest power of an expected light, as a share of that of the smoothest light."""


@dataclass(frozen=True)
class LampKernel:
    """Covariance exp(−d / length) of the deviations of two lamps, where d is their
    distance in u′v′.

    The nugget is the variance that a lamp shares with no other.
    """

    length: float
    nugget: float

    def __call__(self, first: Array, second: Array) -> Array:
        """Shared covariance (n, m) at u′v′ (n, 2) and (m, 2)."""
        distance = np.linalg.norm(first[:, None] - second, axis=-1)
        return np.exp(distance / -self.length)


@dataclass(frozen=True, eq=False)
class LampPrior:
    """Lights expected from lamps at u′v′ (L, 2).

    `weights` (L, N) are those of the kernel around each lamp, `precision` (L, L) is the
    inverse of the covariance of the lamps. `radiometry` (N, 3) leads from power to XYZ.
    """

    uv: Array
    weights: Array
    precision: Array
    kernel: LampKernel
    radiometry: Array

    def __call__(self, uv: Array) -> Array:
        """Power (n, N), of unit X + 15 Y + 3 Z nearly, expected at u′v′ (n, 2)."""
        smooth = smoothest_lights(uv, self.radiometry)
        return _bounded(smooth + self.kernel(uv, self.uv) @ self.weights, smooth)

    def standard_deviation(self, uv: Array) -> Array:
        """Standard deviation (n,) of another lamp at u′v′ (n, 2), relative to that of a
        lamp far from all others.
        """
        shared = self.kernel(uv, self.uv)
        total = 1 + self.kernel.nugget
        variance = total - np.einsum("nl,lm,nm->n", shared, self.precision, shared)
        return np.sqrt(np.maximum(variance, self.kernel.nugget) / total)

    def left_out_deviation(self) -> Array:
        """Standard deviation (L,) of each lamp, as the others predict it; see
        `standard_deviation`.
        """
        return np.sqrt(1 / np.diag(self.precision) / (1 + self.kernel.nugget))


def fit_lamp_prior(
    power: Array, surfaces: Array, radiometry: Array, exact: int = 0
) -> tuple[LampPrior, Array]:
    """Fit the prior to lamps (L, N) of any scale, with the kernel that predicts
    left-out lamps best.

    Predictions are judged by the colours of `surfaces` (P, N). The expected lights
    nearly reach the first `exact` lamps; others of one chromaticity are averaged.
    Returns also the light (L, N) that is expected at the chromaticity of each lamp
    without the lamp, exact in chromaticity.
    """
    power = unit_power(power, radiometry)
    uv = chromaticity(power @ radiometry)
    smooth = smoothest_lights(uv, radiometry)
    own_share = np.where(np.arange(len(uv)) < exact, EXACT_SHARE, 1.0)

    def predict(kernel: LampKernel) -> tuple[Array, Array, Array]:
        # Left-out predictions of all lamps from one inverse: Rasmussen & Williams 2006,
        # "Gaussian processes for machine learning", eq. 5.12.
        inverse = np.asarray(
            np.linalg.inv(kernel(uv, uv) + np.diag(kernel.nugget * own_share))
        )
        weights = inverse @ (power - smooth)
        return (
            inverse,
            weights,
            _bounded(power - weights / np.diag(inverse)[:, None], smooth),
        )

    def error(kernel: LampKernel) -> float:
        return float(
            relit_delta_e(power, predict(kernel)[2], surfaces, radiometry).mean()
        )

    best = min((LampKernel(*pair) for pair in product(LENGTHS, NUGGETS)), key=error)
    precision, weights, expected = predict(best)
    return LampPrior(uv, weights, precision, best, radiometry), nearest_lights(
        expected, uv, radiometry
    )


def smoothest_lights(uv: Array, radiometry: Array) -> Array:
    """Return the lights (n, N) of chromaticities (n, 2) that differ least from the
    equal-energy light.
    """
    return nearest_lights(np.ones((len(uv), len(radiometry))), uv, radiometry)


def _bounded(power: Array, smooth: Array) -> Array:
    """Replace powers that are not positive by a little of the smoothest light."""
    return np.maximum(power, SMOOTHEST_SHARE * smooth)


def relit_delta_e(
    lamps: Array, estimates: Array, reflectances: Array, radiometry: Array
) -> Array:
    """Compare surfaces (P, N) lit by lamps (L, N) with the same surfaces lit by
    estimates of the lamps.

    Returns ΔE00 (L, P) between CIE L*a*b* relative to the white of the respective
    light. Powers have any scale.
    """
    first, second = (
        _relit_lab(power, reflectances, radiometry) for power in (lamps, estimates)
    )
    return delta_e_2000(first, second)


def _relit_lab(power: Array, reflectances: Array, radiometry: Array) -> Array:
    """CIE L*a*b* (L, P, 3).

    For the 10° observer sodium light has no Z. Z relative to white is then the ratio of
    luminances, as it is for all single wavelengths.
    """
    weights = (
        (reflectances[:, :, None] * radiometry)
        .transpose(1, 0, 2)
        .reshape(len(radiometry), -1)
    )
    xyz = (power @ weights).reshape(len(power), -1, 3)
    white = (power @ radiometry)[:, None]
    missing = white <= 0
    return lab(
        np.where(missing, xyz[..., 1:2], xyz), np.where(missing, white[..., 1:2], white)
    )
