"""A symmetric layer that reflects and transmits light, on a ground or on another layer.

Light travels back and forth between the two, which sums to a geometric series.

References
----------
G. G. Stokes, 1862; P. Kubelka, "New contributions to the optics of intensely light-scattering materials, part II",
J. Opt. Soc. Am. 44, 1954, eq. 1–4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array

TINY = np.finfo(float).tiny


@dataclass(frozen=True, eq=False)
class Layer:
    """Optical properties of a layer, the same from both sides.

    Parameters
    ----------
    reflectance : ndarray of shape (..., N)
        Reflectance on a black ground.
    transmittance : ndarray of shape (..., N)
        Transmittance. The sum of both is at most 1.
    """

    reflectance: Array
    transmittance: Array

    def over(self, ground: ArrayLike) -> Array:
        """Return the reflectance on a ground.

        Parameters
        ----------
        ground : array_like of shape (..., N)
            Reflectance of the ground.

        Returns
        -------
        ndarray of shape (..., N)
            Reflectance of both.
        """
        ground = np.asarray(ground, dtype=float)
        return self.reflectance + self.transmittance**2 * ground / self._escaping(ground)

    def stack_on(self, lower: Layer) -> Layer:
        """Combine this layer with one beneath it.

        The result is symmetric only if both layers are of the same material.

        Parameters
        ----------
        lower : Layer
            The layer beneath.

        Returns
        -------
        Layer
            Optical properties of both, from above.
        """
        escaping = self._escaping(lower.reflectance)
        return Layer(self.over(lower.reflectance), self.transmittance * lower.transmittance / escaping)

    def _escaping(self, below: Array) -> Array:
        """Return the fraction of the light in between that leaves per pass; 0 only where no light gets there."""
        return np.maximum(1 - self.reflectance * below, TINY)
