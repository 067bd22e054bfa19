"""What the fit of an atlas entry minds: the measured shape, and its colours under other lights, as least squares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import lab, lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.models import Model

ENDS = 8
"""An end of the spectrum is this part of it: 50 nm of 380–780."""
FLATNESS = 1e-5
"""Keeps multipliers finite where neither the spectrum nor the lights have a say."""


@dataclass(frozen=True)
class Weights:
    """What a fit of an entry minds beside the rms difference of the spectra: docs/fidelity.md compares.

    ``lights`` is what a unit of CIE L*a*b* under a light weighs; ``ends`` what the two ends of the spectrum weigh
    against its middle; ``curvature`` what its second difference weighs.
    """

    lights: float = 0.03
    ends: float = 1.0
    curvature: float = 0.0


BALANCED = Weights()


@dataclass(frozen=True, eq=False)
class Objective:
    """Residuals of a measured reflectance (N,), and their derivative.

    ``basis`` (N, C) is the model's; ``rows`` (R, N) weigh a difference of spectra; ``lights`` (L, 3, N) give XYZ,
    ``whites`` (L, 3) that of the perfect reflector; ``weight`` is that of a unit of L*a*b*.
    """

    model: Model
    basis: Array
    rows: Array
    lights: Array
    whites: Array
    weight: float

    def residuals(self, multipliers: Array, measured: Array) -> Array:
        """(R + 3 L + C,) of multipliers (C,)."""
        spectrum = self.model.squash(self.basis @ multipliers)
        apart = self._colours(spectrum) - self._colours(measured)
        return np.concatenate(
            [self.rows @ (spectrum - measured), self.weight * apart.ravel(), FLATNESS * multipliers]
        )

    def jacobian(self, multipliers: Array) -> Array:
        """(R + 3 L + C, C) derivative of the residuals, whatever was measured."""
        x = self.basis @ multipliers
        change = self.model.slope(x)[:, None] * self.basis
        opponents = lab_jacobian(self.lights @ self.model.squash(x), self.whites)
        colours = (opponents @ (self.lights @ change)).reshape(-1, len(multipliers))
        return np.concatenate(
            [self.rows @ change, self.weight * colours, FLATNESS * np.eye(len(multipliers))]
        )

    def _colours(self, spectrum: Array) -> Array:
        return lab(self.lights @ spectrum, self.whites)


def objective(model: Model, basis: Array, lights: Sequence[Light], weights: Weights) -> Objective:
    """The objective on the wavelengths of ``basis`` (N, C) and of the lights."""
    matrices = np.stack([light.xyz for light in lights])
    whites = np.stack([light.white for light in lights])
    return Objective(model, basis, shape_rows(len(basis), weights), matrices, whites, weights.lights)


def shape_rows(count: int, weights: Weights) -> Array:
    """(R, N) what weighs a difference of spectra (N,), so that the squares of its R products sum to a mean square."""
    share = np.ones(count)
    share[: count // ENDS] = share[-(count // ENDS) :] = weights.ends
    value = np.diag(np.sqrt(share / share.sum()))
    if not weights.curvature:
        return value
    second = np.diff(np.eye(count), n=2, axis=0) * weights.curvature / np.sqrt(count)
    return np.concatenate([value, second])
