"""The step of least change: of all steps that reach a colour, the one that changes the spectrum least.

docs/mathematics.md, 5: Δp = M⁻¹Jᵀ (J M⁻¹Jᵀ + μ tr I)⁻¹ (t − r). Written to the array API: the fit runs it on JAX, the
refined lookup on numpy.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from uplift.models.model import Model
from uplift.models.product import product
from uplift.sensor import Array


class Forward(NamedTuple):
    """From multipliers to RGB: arrays alone, so that JAX passes it through as it is."""

    basis: Any
    """(N, C) linear part of the model."""
    sensor: Any
    """(3, N) spectrum to RGB."""
    products: Any
    """(N, 3·C) sensor × basis, the constant part of the Jacobian."""
    inverse_metric: Any
    """(C, C) M⁻¹, symmetric and positive."""


def forward(
    model: Model, wavelengths: ArrayLike, sensor: Array, inverse_metric: Array | None = None
) -> Forward:
    """The forward model; without a metric, the model's own smoothness."""
    basis = model.basis(wavelengths)
    products = (sensor.T[:, :, None] * basis[:, None, :]).reshape(len(basis), -1)
    metric = np.diag(1 / model.roughness()) if inverse_metric is None else inverse_metric
    return Forward(basis, sensor, products, metric)


def reached(model: Model, forward: Forward, multipliers: Any) -> Any:
    """Linear RGB (n, 3) of multipliers (n, C)."""
    return product(model.squash(product(multipliers, forward.basis.T)), forward.sensor.T)


def residual(model: Model, forward: Forward, multipliers: Any, target: Any) -> Any:
    """Target minus RGB, (n, 3), of multipliers (n, C)."""
    return target - reached(model, forward, multipliers)


def step(model: Model, forward: Forward, multipliers: Any, residual: Any, damping: Any) -> Any:
    """Change of multipliers (n, C) that takes residual (n, 3) away to first order; damping (n,) is μ."""
    slope = model.slope(product(multipliers, forward.basis.T))
    jacobian = product(slope, forward.products).reshape(-1, 3, forward.basis.shape[1])
    weighted = jacobian @ forward.inverse_metric
    gram = weighted @ jacobian.mT
    trace = gram[:, 0, 0] + gram[:, 1, 1] + gram[:, 2, 2]
    y = solve_3x3(gram, damping * trace, residual)
    return (y[:, None, :] @ weighted)[:, 0, :]


def solve_3x3(matrix: Any, shift: Any, right: Any) -> Any:
    """Solve (A + shift I) y = b for symmetric positive A (n, 3, 3), shift (n,), b (n, 3), by L D Lᵀ.

    A pivot that rounding took to zero or below is held at a millionth of an ulp of the trace: the step then
    is long, never NaN, and the caller's check of the residual turns it down.
    """
    xp = matrix.__array_namespace__()
    trace = matrix[:, 0, 0] + matrix[:, 1, 1] + matrix[:, 2, 2]
    floor = 1e-22 * trace + 1e-300
    a, b, c = matrix[:, 0, 0] + shift, matrix[:, 1, 0], matrix[:, 2, 0]
    d0 = xp.maximum(a, floor)
    l10, l20 = b / d0, c / d0
    d1 = xp.maximum(matrix[:, 1, 1] + shift - l10 * b, floor)
    l21 = (matrix[:, 2, 1] - l20 * b) / d1
    d2 = xp.maximum(matrix[:, 2, 2] + shift - l20 * c - l21 * l21 * d1, floor)
    z0 = right[:, 0]
    z1 = right[:, 1] - l10 * z0
    z2 = right[:, 2] - l20 * z0 - l21 * z1
    y2 = z2 / d2
    y1 = z1 / d1 - l21 * y2
    y0 = z0 / d0 - l10 * y1 - l20 * y2
    return xp.stack([y0, y1, y2], axis=-1)
