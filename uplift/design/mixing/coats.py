"""Coats of paint or dye under a surface, for any ground: a uniform colour or the pixels of an image.

All reflectances include the surface. A coat of thickness 0 therefore leaves its ground unchanged. Grounds darker than
the surface alone are treated as black beneath it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing import dyes, kubelka_munk
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.pigments import Pigment, from_black_and_white, from_opaque
from uplift.design.mixing.scattering import Scattering
from uplift.design.mixing.surface import NO_SURFACE, Surface
from uplift.design.mixing.validation import as_length


@dataclass(frozen=True, eq=False)
class Coat:
    """A layer beneath a surface.

    Parameters
    ----------
    layer : Layer
        Optical properties (..., N) of paint or dye.
    surface : Surface
        Surface of the vehicle.
    """

    layer: Layer
    surface: Surface = NO_SURFACE

    def over(self, ground: ArrayLike) -> Array:
        """Return the reflectance of the coat on a ground.

        Parameters
        ----------
        ground : array_like of shape (..., N)
            Reflectance of the ground, surface included.

        Returns
        -------
        ndarray of shape (..., N)
            Reflectance, surface included.
        """
        return self.surface.apply(self.layer.over(_internal(self.surface, ground)))


def from_dyes(spectra: ArrayLike, parts: ArrayLike, thickness: float = 1.0, surface: Surface = NO_SURFACE) -> Coat:
    """Make a coat of dyes.

    Parameters
    ----------
    spectra : array_like of shape (n, N)
        Reflectance of each dye on white, one unit thick, surface included.
    parts : array_like of shape (..., n)
        Amounts of the dyes.
    thickness : float
        Thickness in the same units.
    surface : Surface
        Surface of the vehicle.

    Returns
    -------
    Coat
        The coat.
    """
    mixture = dyes.mix(dyes.from_reflectance(spectra, surface), parts)
    transmittance = dyes.transmittance(mixture, thickness=thickness)
    return Coat(Layer(np.zeros_like(transmittance), transmittance), surface)


def from_pigments(
    paints: Pigment, parts: ArrayLike, thickness: float | None = None, surface: Surface = NO_SURFACE
) -> Coat:
    """Make a coat of paints.

    Parameters
    ----------
    paints : Pigment
        Absorption and scattering (n, N) of the paints; see `stack`.
    parts : array_like of shape (..., n)
        Amounts of the paints.
    thickness : float, optional
        Thickness in units of 1/K and 1/S, by default opaque.
    surface : Surface
        Surface of the vehicle.

    Returns
    -------
    Coat
        The coat.
    """
    mixture = paints.mix(parts)
    if thickness is None:
        reflectance = kubelka_munk.opaque_reflectance(mixture)
        return Coat(Layer(reflectance, np.zeros_like(reflectance)), surface)
    return Coat(kubelka_munk.layer(mixture, as_length(thickness)), surface)


def pigment_from_reflectance(reflectance: ArrayLike, scattering: Scattering, surface: Surface = NO_SURFACE) -> Pigment:
    """Derive absorption and scattering of an opaque paint from its reflectance, surface included.

    Parameters
    ----------
    reflectance : array_like of shape (N,)
        Reflectance of the opaque paint.
    scattering : Scattering
        S that is assumed for a reflectance beneath the surface.
    surface : Surface
        Surface of the vehicle.

    Returns
    -------
    Pigment
        Absorption and scattering (N,).
    """
    return from_opaque(_internal(surface, reflectance), scattering)


def pigment_from_two_grounds(on_white: ArrayLike, on_black: ArrayLike, surface: Surface = NO_SURFACE) -> Pigment:
    """Derive absorption and scattering of a paint, one unit thick, from its reflectances, surface included.

    Parameters
    ----------
    on_white, on_black : array_like of shape (N,)
        Reflectances on white and on black.
    surface : Surface
        Surface of the vehicle.

    Returns
    -------
    Pigment
        Absorption and scattering (N,).

    Raises
    ------
    ColourError
        No paint has both reflectances; see `pigments.from_black_and_white`.
    """
    return from_black_and_white(_internal(surface, on_black), _internal(surface, on_white))


def stack(paints: Sequence[Pigment]) -> Pigment:
    """Stack paints (N,) into one array of paints (n, N).

    Parameters
    ----------
    paints : sequence of Pigment
        The paints.

    Returns
    -------
    Pigment
        Absorption and scattering (n, N).
    """
    return Pigment(np.stack([one.absorption for one in paints]), np.stack([one.scattering for one in paints]))


def _internal(surface: Surface, reflectance: ArrayLike) -> Array:
    return np.clip(surface.remove(reflectance), 0, 1)
