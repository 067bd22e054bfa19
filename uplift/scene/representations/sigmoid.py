"""The sigmoid (SG) of Jakob & Hanika 2019: three numbers a reflectance (`uplift.models.sigmoid`).

They are fitted by Levenberg & Marquardt's method, as an upsampler would: to the reflectance's colour under D65, and
where that leaves anything open, or cannot be had, to its values at 5 nm.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.models import Sigmoid
from uplift.models.model import evaluate
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.table import TabulatedProducts

LIGHT = "D65"
SHAPE = 1e-4
"""What an error at one wavelength counts beside one of the colour."""
STEPS = 20
EASE, EAGER, FIRST = 10.0, 0.3, 1e-3
"""The damping of the first step, and what it grows and falls by after a bad and after a good one."""


@dataclass(frozen=True)
class SigmoidCoefficients(TabulatedProducts):
    """Three coefficients."""

    model: Sigmoid = field(default_factory=Sigmoid)
    name = "SG3"
    family = "sigmoid"

    def encode_surface(self, reflectance: Array) -> Array:
        return fit_sigmoids(self.model, reflectance[:, ::TABLE_STRIDE])


def fit_sigmoids(model: Sigmoid, table: Array) -> Array:
    """Coefficients (n, 3) for reflectances (n, 81)."""
    light, basis = observer.light(LIGHT), model.basis(observer.grid())
    measure = np.concatenate([light.xyz / light.white[:, None], SHAPE * np.eye(len(basis))])

    def misses(found: Array) -> Array:
        return (evaluate(model, found, observer.grid()) - table) @ measure.T

    found = np.zeros((len(table), model.count))
    damping = np.full((len(table), 1, 1), FIRST)
    missed = misses(found)
    for _ in range(STEPS):
        slope = measure @ (model.slope(found @ basis.T)[:, :, None] * basis)
        square = slope.transpose(0, 2, 1) @ slope
        scale = damping * np.einsum("nii->ni", square)[:, :, None] * np.eye(model.count)
        tried = (
            found - np.linalg.solve(square + scale, slope.transpose(0, 2, 1) @ missed[:, :, None])[:, :, 0]
        )
        missed_then = misses(tried)
        better = (missed_then**2).sum(axis=1) < (missed**2).sum(axis=1)
        found[better], missed[better] = tried[better], missed_then[better]
        damping *= np.where(better, EAGER, EASE)[:, None, None]
    return found
