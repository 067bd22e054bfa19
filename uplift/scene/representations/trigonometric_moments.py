"""Trigonometric moments (TM) of reflectances, mirrored, as cubes store them (`uplift.models.moments`).

Peters et al. 2019, "Using moments to represent bounded signals for spectral rendering". These are the moments of the
spectrum itself. The coefficients of cubes are fitted to colours as well; docs/fidelity.md shows the difference.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.models import Moments
from uplift.models.duality import cosine_basis
from uplift.models.matmul import matmul_rows
from uplift.scene.representations.dense import wavelengths
from uplift.scene.representations.table import TabulatedProducts


@dataclass(frozen=True)
class TrigonometricMoments(TabulatedProducts):
    """The zeroth moment and those above it, as many as ``model`` has coefficients."""

    model: Moments
    family = "trigonometric moments"

    @property
    def name(self) -> str:
        return f"TM{self.model.count}"

    def encode_surface(self, reflectance: Array) -> Array:
        phase = self.model.phase(wavelengths())
        analysis = cosine_basis(phase, self.model.count) * np.gradient(phase)[:, None] / np.pi
        analysis[:, 1:] /= 2
        analysis[[0, -1]] /= 2
        return np.asarray(matmul_rows(reflectance, analysis))


def trigonometric_moments(count: int) -> TrigonometricMoments:
    """Make the representation by ``count`` coefficients."""
    return TrigonometricMoments(Moments(count))
