"""Few wavelengths in place of all: spectra as a renderer sees them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.sensor import Array, Light


@dataclass(frozen=True, eq=False)
class Rendering:
    """``wavelengths`` (K,) nm, and weights (L, 3, K) that take reflectances there to XYZ under each of L lights."""

    wavelengths: Array
    weights: Array

    def xyz(self, reflectances: Array) -> list[Array]:
        """(n, 3) under each light, of reflectances (n, K)."""
        return [reflectances @ weights.T for weights in self.weights]


def at_all(wavelengths: Array, lights: Sequence[Light]) -> Rendering:
    """Every wavelength (N,) of the lights' own grid."""
    return Rendering(wavelengths, np.stack([light.xyz for light in lights]))
