"""The four ways to lay a spectrum on the circle before its moments are taken: mirrored or not, warped or not.

Tódová 2020, *Constrained Spectral Uplifting*, 2.2.1 and 4.1.1; Peters et al. 2019, section 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.models import duality
from uplift.models.phase import Phase


@dataclass(frozen=True)
class Technique:
    """Whether the spectrum is mirrored, so that its moments are real, and whether its phase is warped.

    Mirrored, [start, end] nm (those of `Phase`) takes the half circle [−π, 0]; unmirrored the whole one,
    [−π, π], where the two ends meet.
    """

    mirrored: bool
    warped: bool

    @property
    def short(self) -> str:
        """As the thesis abbreviates it: M&W, M&nW, nM&W, nM&nW."""
        return f"{'' if self.mirrored else 'n'}M&{'' if self.warped else 'n'}W"

    @property
    def label(self) -> str:
        return f"{'mirrored' if self.mirrored else 'unmirrored'}, {'warped' if self.warped else 'unwarped'}"

    def floats(self, moments: int) -> int:
        """Numbers to store for the zeroth moment and ``moments`` more."""
        return moments + 1 if self.mirrored else 2 * moments + 1

    def phase(self, wavelengths: ArrayLike) -> Array:
        """Phases (N,) of wavelengths (N,) in nm."""
        half = Phase(warp="vision" if self.warped else "none")(wavelengths)
        return half if self.mirrored else 2 * half + np.pi

    def moments(self, reflectance: Array, wavelengths: ArrayLike, moments: int) -> duality.Complex | Array:
        """Moments (n, moments + 1) of reflectances (n, N) at ascending wavelengths (N,) nm, end to end.

        Exact for the function that is linear in the phase between the samples, so that they are moments of
        a reflectance whenever the samples are within [0, 1]. Real if mirrored.
        """
        phase = self.phase(wavelengths)
        found = _integrals(reflectance, phase, moments) / np.ptp(phase)
        return np.ascontiguousarray(found.real) if self.mirrored else found

    def reconstruct(self, moments: duality.Complex | Array, wavelengths: ArrayLike) -> Array:
        """Bounded maximum-entropy reflectances (n, N) at wavelengths (N,) nm of moments (n, C).

        Raises
        ------
        UpliftError : no reflectance has these moments.
        """
        multipliers = duality.multipliers_from_moments(moments)
        waves = duality.fourier_basis(self.phase(wavelengths), moments.shape[1])
        return np.asarray(0.5 + np.arctan((multipliers @ waves.T).real) / np.pi)


TECHNIQUES = tuple(Technique(mirrored, warped) for mirrored in (True, False) for warped in (True, False))
"""In the order of the thesis's tables."""


def _integrals(values: Array, phase: Array, moments: int) -> duality.Complex:
    """∫ g exp(−ijφ) dφ (n, moments + 1) of g linear between ``values`` (n, N) at phases (N,).

    Twice by parts: what is left is the ends, and the slopes times how far exp(−ijφ) travels in each interval.
    """
    orders = np.arange(1, moments + 1)
    turn = np.exp(-1j * phase[:, None] * orders)
    ends = values[:, -1:] * turn[-1] - values[:, :1] * turn[0]
    slopes = np.diff(values, axis=1) / np.diff(phase)
    found = np.empty((len(values), moments + 1), dtype=complex)
    found[:, 0] = np.trapezoid(values, phase, axis=1)
    found[:, 1:] = 1j * ends / orders + slopes @ np.diff(turn, axis=0) / orders**2
    return found
