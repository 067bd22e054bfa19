"""Steps towards a colour: of all steps that reach it, the one that changes the spectrum least.

Multipliers p are changed in the metric M = (R Rᵀ)⁻¹, as x = R⁻¹ p; A is the Jacobian of the RGB r with respect to x.
The minimum-norm step Δx = A⁺ (t − r) changes the current spectrum least. The step of least change,
Δx = A⁺ (t − r + A d) − d, changes the prior spectrum least, from which x differs by d. A⁺ = Aᵀ (A Aᵀ + μ tr I)⁻¹
(docs/mathematics.md, 5). The functions use the array API: the fit runs them on JAX, the refined lookup on numpy.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.models.matmul import matmul_rows
from uplift.models.model import Model


class ForwardMap(NamedTuple):
    """Arrays of the map from multipliers to RGB, a pytree for JAX."""

    basis: Any
    """Basis of the linear part, shape (N, C)."""
    sensor: Any
    """Spectrum to RGB, shape (3, N)."""
    root: Any
    """R with R Rᵀ = M⁻¹, shape (C, C)."""
    inverse_root: Any
    """R⁻¹, shape (C, C)."""
    products: Any
    """Sensor times basis times R, shape (N, 3·C): the constant part of the Jacobian with respect to R⁻¹ p."""


def forward_map(model: Model, wavelengths: ArrayLike, sensor: Array, inverse_metric: Array | None = None) -> ForwardMap:
    """Create the forward map; the metric defaults to the roughness of the model."""
    basis = model.basis(wavelengths)
    root = np.linalg.cholesky(np.diag(1 / model.roughness()) if inverse_metric is None else inverse_metric)
    products = sensor.T[:, :, None] * (basis @ root)[:, None, :]
    return ForwardMap(basis, sensor, root, np.linalg.inv(root), products.reshape(len(basis), -1))


def forward_rgb(model: Model, forward_map: ForwardMap, multipliers: Any) -> Any:
    """Compute linear RGB (n, 3) of multipliers (n, C)."""
    return matmul_rows(model.squash(matmul_rows(multipliers, forward_map.basis.T)), forward_map.sensor.T)


def residual(model: Model, forward_map: ForwardMap, multipliers: Any, target: Any) -> Any:
    """Compute target minus RGB, (n, 3), of multipliers (n, C)."""
    return target - forward_rgb(model, forward_map, multipliers)


def minimum_norm_step(model: Model, forward_map: ForwardMap, multipliers: Any, residual: Any, damping: Any) -> Any:
    """Compute the change of multipliers (n, C) that cancels residual (n, 3) to first order; damping (n,) is μ."""
    step = least_change_step(model, forward_map, multipliers, residual, damping, 0 * multipliers)
    return matmul_rows(step, forward_map.root.T)


def least_change_step(
    model: Model, forward_map: ForwardMap, multipliers: Any, residual: Any, damping: Any, moved: Any
) -> Any:
    """Compute the change of x (n, C) that cancels residual (n, 3) to first order, nearest to the prior.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward_map : ForwardMap
        Map from multipliers to RGB.
    multipliers : array, shape (n, C)
        Current multipliers.
    residual : array, shape (n, 3)
        Target minus RGB.
    damping : array, shape (n,)
        μ, 0 or more.
    moved : array, shape (n, C)
        Difference d of x from the prior; 0 for the minimum-norm step.

    Returns
    -------
    array, shape (n, C)
        Change of x; multiplied by R it is that of the multipliers.
    """
    slope = model.slope(matmul_rows(multipliers, forward_map.basis.T))
    jacobian = matmul_rows(slope, forward_map.products).reshape(-1, 3, forward_map.basis.shape[1])
    gram = jacobian @ jacobian.mT
    lower = [[gram[:, a, b] for b in range(a + 1)] for a in range(3)]
    goal = residual + (jacobian @ moved[:, :, None])[:, :, 0]
    y = solve_3x3(lower, damping * (lower[0][0] + lower[1][1] + lower[2][2]), goal.T)
    y = jacobian.__array_namespace__().stack(y, axis=-1)
    return (y[:, None, :] @ jacobian)[:, 0, :] - moved


def solve_3x3(matrix: Sequence[Sequence[Any]], shift: Any, right: Any) -> tuple[Any, Any, Any]:
    """Solve (A + shift I) y = b for n symmetric positive A by L D Lᵀ; all elements are arrays (n,).

    ``matrix`` is the lower half of A, row by row. A pivot that rounding made zero or negative is replaced by a
    millionth of an ulp of the trace. The step is then long, never NaN, and the caller's check of the residual rejects
    it.
    """
    (a00,), (a10, a11), (a20, a21, a22) = matrix
    xp = a00.__array_namespace__()
    floor = 1e-22 * (a00 + a11 + a22) + 1e-300
    d0 = xp.maximum(a00 + shift, floor)
    l10, l20 = a10 / d0, a20 / d0
    d1 = xp.maximum(a11 + shift - l10 * a10, floor)
    l21 = (a21 - l20 * a10) / d1
    d2 = xp.maximum(a22 + shift - l20 * a20 - l21 * l21 * d1, floor)
    z0 = right[0]
    z1 = right[1] - l10 * z0
    z2 = right[2] - l20 * z0 - l21 * z1
    y2 = z2 / d2
    y1 = z1 / d1 - l21 * y2
    return z0 / d0 - l10 * y1 - l20 * y2, y1, y2
