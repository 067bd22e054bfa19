"""Coats of paints and dyes that are known by their colours, on any ground: a uniform
colour or the pixels of an image.

All reflectances include the surface. A coat of thickness 0 therefore leaves its ground
unchanged. Grounds darker than the surface alone are treated as black beneath it.

Dyes absorb and do not scatter (Fishkin 1983, eq. 9.3–9.7). Of the light that enters, 1
− ρ, the i-th pass contributes (1 − ρ) (1 − ρ_i) (T² R_g)^i ρ_i^(i−1), so that a dye on
a ground R_g in optical contact has

    R = ρ + (1 − ρ) (1 − ρ_i) T² R_g / (1 − ρ_i T² R_g),

which is Saunderson's correction (eq. 10.10) of T² R_g, or Kubelka and Munk's result
without scattering. The thesis prints, with ρ_i = ρ, (1 − ρ)² / (ρ (1 − ρ T² R_g)): its
sum starts at 1, but the term i = 0 was not subtracted.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import SLACK
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftWarning, warn
from uplift.common.text import pluralise
from uplift.extras.paint.optics import (
    NO_SURFACE,
    Coat,
    Layer,
    Surface,
    as_shares,
    check_thickness,
    plate,
    weighted_sum,
)
from uplift.extras.paint.pigments import (
    Pigment,
    Scattering,
    from_black_and_white,
    from_opaque,
)

DARKEST = 1e-6
"""Smallest transmittance that the absorption of a dye is derived from; it diverges at
0.
"""


@dataclass(frozen=True, eq=False)
class Pigments:
    """Paints that absorb and scatter light, by their reflectance.

    Parameters
    ----------
    spectra : ndarray of shape (n, N)
        Reflectance of opaque paints. With a colour on black, that of a layer one unit
        thick on white.
    scattering : callable, optional
        S of paints that are given by one colour, which need it; see `dispersive`.
    on_black : tuple of ndarray of shape (N,) or None, one for each paint, optional
        Reflectance of the same layer on black.
    """

    spectra: Array
    scattering: Scattering | None = None
    on_black: tuple[Array | None, ...] = ()

    def coat(
        self,
        parts: ArrayLike,
        thickness: float | None = None,
        surface: Surface = NO_SURFACE,
    ) -> Coat:
        """Make a coat. A warning states how many colours are darker than the surface
        alone at some wavelengths.

        Parameters
        ----------
        parts : array_like of shape (..., n)
            Amounts of the paints.
        thickness : float, optional
            Thickness in units, by default opaque.
        surface : Surface
            Surface of the vehicle.

        Returns
        -------
        Coat
            The coat; ``coat.over(ground)`` is its reflectance on a ground.

        Raises
        ------
        OptionError
            Parts or thickness are invalid, or the scattering is missing.
        ColourError
            No paint has the given reflectances on white and on black.
        """
        on_black = self.on_black or (None,) * len(self.spectra)
        known = [colour for colour in on_black if colour is not None]
        _warn_of_darkness(np.stack([*self.spectra, *known]), surface)
        paints = [
            self._paint(white, black, surface)
            for white, black in zip(self.spectra, on_black, strict=True)
        ]
        pigment = Pigment(
            np.stack([paint.absorption for paint in paints]),
            np.stack([paint.scattering for paint in paints]),
        )
        return pigment.coat(parts, thickness, surface)

    def _paint(self, white: Array, black: Array | None, surface: Surface) -> Pigment:
        internal = surface.beneath(white)
        if black is not None:
            return from_black_and_white(surface.beneath(black), internal)
        if self.scattering is None:
            raise OptionError(
                "one colour does not determine the scattering of a pigment",
                hint="state the scattering, or give a colour on black",
            )
        return from_opaque(internal, self.scattering)


@dataclass(frozen=True, eq=False)
class Dyes:
    """Dyes, which absorb light and do not scatter it.

    Parameters
    ----------
    spectra : ndarray of shape (..., n, N)
        Reflectance one unit thick on white.
    """

    spectra: Array

    def coat(
        self,
        parts: ArrayLike,
        thickness: float | None = None,
        surface: Surface = NO_SURFACE,
    ) -> Coat:
        """Make a coat in optical contact with its ground; see `Pigments.coat`. It is
        one unit thick by default.
        """
        transmittance = self._transmittance(parts, thickness, surface)
        return Coat(Layer(np.zeros_like(transmittance), transmittance), surface)

    def _transmittance(
        self, parts: ArrayLike, thickness: float | None, surface: Surface
    ) -> Array:
        """Return T = exp(−K X) (Beer, eq. 9.5), where the dyes of a mixture add their
        absorption by shares.
        """
        check_thickness(thickness)
        _warn_of_darkness(self.spectra, surface)
        absorption = dye_absorption(self.spectra, surface)
        mixed = weighted_sum(absorption, as_shares(parts))
        return np.exp(-(1.0 if thickness is None else thickness) * mixed)


class Plates(Dyes):
    """Dyes in a free plate with a surface on both sides, behind which the ground is
    across a gap of air.
    """

    def coat(
        self,
        parts: ArrayLike,
        thickness: float | None = None,
        surface: Surface = NO_SURFACE,
    ) -> Coat:
        """Make a plate; see `Dyes.coat`."""
        transmittance = self._transmittance(parts, thickness, surface)
        return Coat(plate(transmittance, surface.outside))


def dye_absorption(reflectance: ArrayLike, surface: Surface = NO_SURFACE) -> Array:
    """Return the absorption (..., N) of a dye, one unit thick, from its reflectance on
    perfect white (eq. 9.7, 9.5).
    """
    transmittance = np.sqrt(surface.beneath(reflectance))
    return -np.log(np.clip(transmittance, DARKEST, 1))


def _warn_of_darkness(colours: Array, surface: Surface) -> None:
    dark = (surface.remove(colours) < -SLACK).any(axis=-1).sum()
    if dark:
        problem = (
            f"{dark} of {pluralise(len(colours), 'colour')} partly darker than the "
            "surface alone: black there"
        )
        warn(UpliftWarning(problem))
