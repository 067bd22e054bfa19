"""The prior of a paint before it is fitted: K and S that its purest sample suggests,
and how far they may be off.

The ratio K/S is that of the purest sample, taken as opaque. Its scattering is the rule
of `uplift.extras.paint.pigments.dispersive`, lower for coloured paints than for white.
The logarithms of S and of K/S differ from these by smooth functions of the wavelength,
and S by a factor as well. The spreads are those of 19 measured acrylics
(docs/mixing.md).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.extras.paint.optics import Surface
from uplift.extras.paint.paint_samples import PaintSamples
from uplift.extras.paint.pigments import Pigment, dispersive, from_opaque

LENGTH = 45.0
"""Distance in nm at which the correlation of differences falls to e^−½."""
SCATTERING_SPREAD = 0.7
"""Standard deviation of the smooth difference of log S."""
RATIO_SPREAD = 1.5
"""The same of log K/S."""
ROUGHNESS = 0.5
"""Standard deviation of differences that are independent at each wavelength."""
STRENGTH_SPREAD = 1.0
"""Standard deviation of the logarithm of the factor of S of a paint."""
COLOURED = 1.5
"""By how much log S of coloured paints lies below that of white by the rule."""
UNIT_SPREAD = 5.0
"""Standard deviation of the logarithm of the unit of thickness."""
LIMITS = (0.01, 0.99)
"""Internal reflectances that K/S is derived from; beyond, it is not determined."""


@dataclass(frozen=True, eq=False)
class PaintPrior:
    """Gaussian prior of log S and log K/S of P paints at N wavelengths, in variables z
    that are independent standard normal.

    Of each paint they are the factor of S, N numbers for log S and N for log K/S. The
    last variable is the unit of thickness.
    """

    log_scattering: Array  # (P, N)
    log_ratio: Array  # (P, N)
    scattering_root: Array  # (N, N), a Cholesky factor
    ratio_root: Array  # (N, N)
    unit_spread: float

    @property
    def count(self) -> int:
        """Number of variables."""
        paints, samples = self.log_scattering.shape
        return paints * (2 * samples + 1) + 1

    def pigments(self, z: Any) -> Pigment:
        """Return K and S (P, N) of variables (count,), arrays of numpy or JAX."""
        xp = z.__array_namespace__()
        paints, samples = self.log_scattering.shape
        rows = xp.reshape(z[:-1], (paints, 2 * samples + 1))
        factor = STRENGTH_SPREAD * rows[:, :1] + self.unit_spread * z[-1]
        smooth = rows[:, 1 : samples + 1] @ self.scattering_root.T
        log_S = self.log_scattering + factor + smooth
        log_ratio = self.log_ratio + rows[:, samples + 1 :] @ self.ratio_root.T
        scattering = xp.exp(log_S)
        return Pigment(xp.exp(log_ratio) * scattering, scattering)


def paint_prior(
    samples: PaintSamples, spectra: Array, surface: Surface, sensor: Sensor
) -> PaintPrior:
    """Make the prior of the paints of samples.

    ``spectra`` (n, N) are the reflectances of the samples, or a guess of them, and
    ``sensor`` has their wavelengths.
    """
    purest = [_purest(samples, paint) for paint in range(len(samples.paints))]
    internal = np.clip(surface.remove(spectra[purest]), *LIMITS)
    guess = from_opaque(internal, dispersive(sensor))
    whiteness = internal.min(axis=1, keepdims=True)
    has_films = not samples.is_opaque.all()
    return PaintPrior(
        np.log(guess.scattering) - COLOURED * (1 - whiteness),
        np.log(guess.absorption / guess.scattering),
        _root(samples.wavelengths, SCATTERING_SPREAD),
        _root(samples.wavelengths, RATIO_SPREAD),
        UNIT_SPREAD if has_films else 0.0,
    )


def _purest(samples: PaintSamples, paint: int) -> int:
    """Return the sample with the largest share of a paint, an opaque one if any."""
    order = np.lexsort((samples.is_opaque, samples.shares[:, paint].round(9)))
    return int(order[-1])


def _root(wavelengths: Array, spread: float) -> Array:
    distance = wavelengths[:, None] - wavelengths
    smooth = spread**2 * np.exp(-((distance / LENGTH) ** 2) / 2)
    rough = ROUGHNESS**2 * np.eye(len(wavelengths))
    return np.asarray(np.linalg.cholesky(smooth + rough))
