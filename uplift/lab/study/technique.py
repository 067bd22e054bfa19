"""Four techniques that map a spectrum to the circle before its moments are computed: mirrored or not, warped or not.

Tódová 2020, *Constrained Spectral Uplifting*, sections 2.2.1 and 4.1.1; Peters et al. 2019, section 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Complex
from uplift.models import duality
from uplift.models.phase import Phase

__all__ = ["TECHNIQUES", "Technique"]


@dataclass(frozen=True)
class Technique:
    """A mapping of the spectrum to the circle.

    Parameters
    ----------
    mirrored : bool
        Map [start, end] nm of `Phase` to the half circle [−π, 0] and mirror it, which makes the moments real.
        Otherwise the range covers the circle [−π, π], and its two ends meet.
    warped : bool
        Warp the phase towards wavelengths to which the eye is sensitive.
    """

    mirrored: bool
    warped: bool

    @property
    def short(self) -> str:
        """Abbreviation of the thesis: M&W, M&nW, nM&W or nM&nW."""
        return f"{'' if self.mirrored else 'n'}M&{'' if self.warped else 'n'}W"

    @property
    def label(self) -> str:
        """Full name, such as ``mirrored, warped``."""
        return f"{'mirrored' if self.mirrored else 'unmirrored'}, {'warped' if self.warped else 'unwarped'}"

    def floats(self, moments: int) -> int:
        """Count the real numbers stored per spectrum.

        Parameters
        ----------
        moments : int
            Number of moments above the zeroth.

        Returns
        -------
        int
            Real numbers.
        """
        return moments + 1 if self.mirrored else 2 * moments + 1

    def phase(self, wavelengths: ArrayLike) -> Array:
        """Map wavelengths to phases.

        Parameters
        ----------
        wavelengths : array_like, shape (N,)
            Wavelengths in nm.

        Returns
        -------
        ndarray, shape (N,)
            Phases in radians.
        """
        half = Phase(warp="vision" if self.warped else "none")(wavelengths)
        return half if self.mirrored else 2 * half + np.pi

    def moments(self, reflectance: Array, wavelengths: ArrayLike, moments: int) -> Complex | Array:
        """Compute the moments of reflectances.

        They are exact for the interpolant that is linear in the phase, so samples within [0, 1] have moments of a
        reflectance.

        Parameters
        ----------
        reflectance : ndarray, shape (n, N)
            Reflectances.
        wavelengths : array_like, shape (N,)
            Ascending wavelengths in nm that cover the range.
        moments : int
            Number of moments above the zeroth.

        Returns
        -------
        ndarray, shape (n, moments + 1)
            Moments, real for a mirrored spectrum and complex otherwise.
        """
        phase = self.phase(wavelengths)
        on_circle = _integrals(reflectance, phase, moments) / np.ptp(phase)
        return np.ascontiguousarray(on_circle.real) if self.mirrored else on_circle

    def reconstruct(self, moments: Complex | Array, wavelengths: ArrayLike) -> Array:
        """Compute bounded maximum-entropy reflectances from moments.

        Parameters
        ----------
        moments : ndarray, shape (n, C)
            Moments as computed by `moments`.
        wavelengths : array_like, shape (N,)
            Wavelengths in nm.

        Returns
        -------
        ndarray, shape (n, N)
            Reflectances.

        Raises
        ------
        UpliftError
            No reflectance has these moments.
        """
        multipliers = duality.multipliers_from_moments(moments)
        waves = duality.fourier_basis(self.phase(wavelengths), moments.shape[1])
        return np.asarray(0.5 + np.arctan((multipliers @ waves.T).real) / np.pi)


TECHNIQUES = tuple(Technique(mirrored, warped) for mirrored in (True, False) for warped in (True, False))
"""All techniques, in the order of the tables of the thesis."""


def _integrals(values: Array, phase: Array, moments: int) -> Complex:
    """Integrals (n, moments + 1) of g exp(−ijφ) dφ, with g linear between ``values`` (n, N) at phases (N,).

    Integrated by parts twice: a term of the two ends, and the slopes times the change of exp(−ijφ) in each interval.
    """
    orders = np.arange(1, moments + 1)
    turn = np.exp(-1j * phase[:, None] * orders)
    ends = values[:, -1:] * turn[-1] - values[:, :1] * turn[0]
    slopes = np.diff(values, axis=1) / np.diff(phase)
    integrals = np.empty((len(values), moments + 1), dtype=complex)
    integrals[:, 0] = np.trapezoid(values, phase, axis=1)
    integrals[:, 1:] = 1j * ends / orders + slopes @ np.diff(turn, axis=0) / orders**2
    return integrals
