"""Least-squares objective for one atlas entry: the measured spectrum, and its colours under several lights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import lab_jacobian, lab_of
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.models import Model

ENDS = 8
"""Each end of the spectrum is this part of it: 50 nm of 380–780."""
FLATNESS = 1e-5
"""Weight that keeps the constant multiplier finite where neither the spectrum nor the lights constrain it."""


@dataclass(frozen=True)
class Weights:
    """Weights of the objective, relative to the root-mean-square difference of the spectra (docs/fidelity.md).

    Parameters
    ----------
    lights : float, default 0.03
        Weight of a unit of CIE L*a*b* under a light.
    ends : float, default 1
        Weight of the two ends of the spectrum relative to its middle.
    curvature : float, default 0
        Weight of the second difference.
    smoothness : float, default 1e-3
        Weight of the multipliers but the constant one, in the metric M of docs/mathematics.md, 5. Without it the
        minimum of a dark entry jumps: of two spectra that meet its colours nearly equally well, one has multipliers
        ten times as large, and noise of the measurement decides between them.
    """

    lights: float = 0.03
    ends: float = 1.0
    curvature: float = 0.0
    smoothness: float = 1e-3


BALANCED = Weights()


@dataclass(frozen=True, eq=False)
class Objective:
    """Residuals of the fit of a measured reflectance (N,), and their derivative.

    Parameters
    ----------
    model : Model
        Spectrum model.
    basis : ndarray, shape (N, C)
        Basis of the model.
    values : ndarray, shape (N,)
        Weights of the values of a difference of spectra.
    bends : ndarray, shape (B, N)
        Weights of its second differences.
    lights : ndarray, shape (L, 3, N)
        Maps from spectra to XYZ.
    whites : ndarray, shape (L, 3)
        XYZ of the perfect reflector.
    weight : float
        Weight of a unit of CIE L*a*b*.
    multipliers : ndarray, shape (C,)
        Weights of the multipliers.
    """

    model: Model
    basis: Array
    values: Array
    bends: Array
    lights: Array
    whites: Array
    weight: float
    multipliers: Array

    def residuals(self, multipliers: Any, measured: Any) -> Any:
        """Residuals (N + B + 3 L + C,) of multipliers (C,); both of numpy or of JAX."""
        return self.residuals_from(multipliers, measured, self.colours(measured))

    def colours(self, spectrum: Any) -> Any:
        """CIE L*a*b* (L, 3) of a spectrum (N,) under the lights."""
        return lab_of(self.lights @ spectrum, self.whites)

    def residuals_from(self, multipliers: Any, measured: Any, colours: Any) -> Any:
        """Compute `residuals` of a measurement (N,) whose colours (L, 3) are known."""
        spectrum = self.model.squash(self.basis @ multipliers)
        difference, colour_difference = spectrum - measured, self.colours(spectrum) - colours
        return multipliers.__array_namespace__().concat(
            [
                self.values * difference,
                self.bends @ difference,
                self.weight * colour_difference.ravel(),
                self.multipliers * multipliers,
            ]
        )

    def jacobian(self, multipliers: Array) -> Array:
        """Derivative (N + B + 3 L + C, C) of the residuals; it does not depend on the measurement."""
        x = self.basis @ multipliers
        change = self.model.slope(x)[:, None] * self.basis
        to_lab = lab_jacobian(self.lights @ self.model.squash(x), self.whites)
        colours = (to_lab @ (self.lights @ change)).reshape(-1, len(multipliers))
        return np.concatenate(
            [
                self.values[:, None] * change,
                self.bends @ change,
                self.weight * colours,
                np.diag(self.multipliers),
            ]
        )

    def steepness(self, multipliers: Array, measured: Array) -> float:
        """Largest cosine of the angle between the residuals and their derivatives: 0 at a minimum, NaN without one."""
        slopes, off = self.jacobian(multipliers), self.residuals(multipliers, measured)
        return float(np.abs(slopes.T @ off / (np.linalg.norm(slopes, axis=0) * np.linalg.norm(off))).max())


def objective(model: Model, basis: Array, lights: Sequence[Light], weights: Weights) -> Objective:
    """Make the objective at the wavelengths of ``basis`` (N, C) and of the lights."""
    matrices = np.stack([light.xyz for light in lights])
    whites = np.stack([light.white for light in lights])
    return Objective(
        model,
        basis,
        *shape_weights(len(basis), weights),
        matrices,
        whites,
        weights.lights,
        multiplier_weights(model, weights),
    )


def multiplier_weights(model: Model, weights: Weights) -> Array:
    """Weights (C,) of multipliers: the constant one is left to the measurement."""
    smooth = np.maximum(weights.smoothness * np.sqrt(model.roughness()), FLATNESS)
    return np.where(model.constant() > 0, FLATNESS, smooth)


def shape_weights(count: int, weights: Weights) -> tuple[Array, Array]:
    """Weights (N,) of the values of a difference of spectra (N,), and (B, N) of its second differences.

    The squares of all products sum to a weighted mean square.
    """
    share = np.ones(count)
    share[: count // ENDS] = share[-(count // ENDS) :] = weights.ends
    second = np.diff(np.eye(count), n=2, axis=0) if weights.curvature else np.zeros((0, count))
    return np.sqrt(share / share.sum()), second * weights.curvature / np.sqrt(count)
