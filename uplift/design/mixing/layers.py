"""A layer that reflects and lets through, alike from both sides; on a ground, and on another layer.

Light goes to and fro between the two: a geometric series (Stokes 1862; P. Kubelka 1954, "New contributions to the
optics of intensely light-scattering materials, part II", J. Opt. Soc. Am. 44, eq. 1–4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array

LEAST = np.finfo(float).tiny


@dataclass(frozen=True, eq=False)
class Layer:
    """``reflectance`` on a black ground and ``transmittance``, both (…, N); their sum is 1 at most."""

    reflectance: Array
    transmittance: Array

    def over(self, ground: ArrayLike) -> Array:
        """Reflectance (…, N) on a ground of reflectance (…, N)."""
        ground = np.asarray(ground, dtype=float)
        return self.reflectance + self.transmittance**2 * ground / self._leaving(ground)

    def upon(self, lower: Layer) -> Layer:
        """This layer and one beneath it, as one. It is alike from both sides only if both are of one material."""
        leaving = self._leaving(lower.reflectance)
        return Layer(self.over(lower.reflectance), self.transmittance * lower.transmittance / leaving)

    def _leaving(self, below: Array) -> Array:
        """What of the light between does not come back; 0 only where no light gets there."""
        return np.maximum(1 - self.reflectance * below, LEAST)
