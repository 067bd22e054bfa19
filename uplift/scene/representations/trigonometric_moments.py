"""Trigonometric moments (TM) of reflectances, mirrored, as cubes store them (`uplift.models.moments`).

Peters et al. 2019, "Using moments to represent bounded signals for spectral rendering". These are the plain moments
of the spectrum, not coefficients fitted to its colours as those of cubes are: docs/fidelity.md has what that gains.
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
    """As many coefficients as ``model`` has: the zeroth moment and those above it."""

    model: Moments

    @property
    def name(self) -> str:
        return f"TM{self.model.count}"

    @property
    def family(self) -> str:
        return "trigonometric moments"

    def encode_surface(self, reflectance: Array) -> Array:
        phase = self.model.phase(wavelengths())
        analysis = cosine_basis(phase, self.model.count) * np.gradient(phase)[:, None] / np.pi
        analysis[:, 1:] /= 2
        analysis[[0, -1]] /= 2
        return np.asarray(matmul_rows(reflectance, analysis))


def trigonometric_moments(count: int) -> TrigonometricMoments:
    """``count`` coefficients."""
    return TrigonometricMoments(Moments(count))
