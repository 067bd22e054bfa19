"""Steps towards a colour: of all steps that reach it, the one that changes the spectrum
least.

Multipliers p are changed in the metric M = (R Rᵀ)⁻¹, as x = R⁻¹ p; A = ∂r/∂x is the
Jacobian of the RGB r, and t the target (docs/mathematics.md, 5). With the damped
pseudo-inverse A⁺ = Aᵀ (A Aᵀ + μ tr I)⁻¹,

- Δx = A⁺ (t − r) changes the current spectrum least: the minimum-norm step, of the
  lookup and of atlas entries,
- Δx = A⁺ (t − r + A d) − d changes the prior spectrum least, from which x differs by d:
  the step of the nodes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.models.arithmetic import blocked_matmul, blocked_matmul_columns
from uplift.models.model import Model


@dataclass(frozen=True, eq=False)
class ForwardMap:
    """The map r = W S(B p) from multipliers p of a model to linear RGB, and the metric;
    a pytree for JAX.
    """

    model: Model
    basis: Any
    """B, shape (N, C)."""
    sensor: Any
    """W, spectrum to RGB, shape (3, N)."""
    root: Any
    """R with R Rᵀ = M⁻¹, shape (C, C)."""
    inverse_root: Any
    """R⁻¹, shape (C, C)."""
    jacobian_basis: Any
    """W times B R, shape (N, 3·C): the constant part of the Jacobian A."""

    def residual(self, multipliers: Any, target: Any) -> Any:
        """Target minus RGB, t − r, (n, 3), of multipliers (n, C)."""
        spectra = self.model.to_reflectance(blocked_matmul(multipliers, self.basis.T))
        return target - blocked_matmul(spectra, self.sensor.T)


def forward_map(model: Model, wavelengths: ArrayLike, sensor: Array) -> ForwardMap:
    """Create the forward map at wavelengths (N,) with the metric M of the model."""
    basis = model.basis(wavelengths)
    root = np.linalg.cholesky(np.diag(1 / model.metric_diagonal()))
    jacobian_basis = sensor.T[:, :, None] * (basis @ root)[:, None, :]
    return ForwardMap(
        model,
        basis,
        sensor,
        root,
        inverse_root=np.linalg.inv(root),
        jacobian_basis=jacobian_basis.reshape(len(basis), -1),
    )


def anchored_step(
    forward: ForwardMap,
    multipliers: Any,
    residual: Any,
    damping: Any,
    displacement: Any,
) -> Any:
    """Change Δx (n, C) that cancels residuals (n, 3) to first order, nearest to the
    prior; R Δx is that of multipliers.

    ``damping`` (n,) is μ, ``displacement`` (n, C) the difference d of x from the prior,
    0 for the minimum-norm step. Spectra are rows of arrays of numpy or of JAX.
    """
    # A = W diag(S′(B p)) B R
    derivative = forward.model.derivative(blocked_matmul(multipliers, forward.basis.T))
    jacobian = blocked_matmul(derivative, forward.jacobian_basis).reshape(
        -1, 3, forward.basis.shape[1]
    )
    # y = (A Aᵀ + μ tr I)⁻¹ (t − r + A d), Δx = Aᵀ y − d
    gram = jacobian @ jacobian.mT
    lower = []
    for a in range(3):
        lower.append([gram[:, a, b] for b in range(a + 1)])
    goal = residual + (jacobian @ displacement[:, :, None])[:, :, 0]
    y = solve_damped(lower, damping, goal.T)
    y = jacobian.__array_namespace__().stack(y, axis=-1)
    return (y[:, None, :] @ jacobian)[:, 0, :] - displacement


def minimum_norm_step(
    forward: ForwardMap, linear: Array, residual: Array, damping: Array
) -> Array:
    """Change R Δx (C, n) of multipliers that cancels residuals (3, n) to first order,
    from the linear part (N, n).

    Spectra are columns of numpy arrays here, so that all arithmetic runs along
    contiguous memory.
    """
    # Aᵀ = Rᵀ Bᵀ diag(S′(x)) Wᵀ, by columns; Δx = Aᵀ (A Aᵀ + μ tr I)⁻¹ (t − r)
    jacobian = blocked_matmul_columns(
        forward.jacobian_basis.T, forward.model.derivative(linear)
    )
    jacobian = jacobian.reshape(3, len(forward.root), -1)
    lower = []
    for a, row in enumerate(jacobian):
        lower.append([np.einsum("cn,cn->n", row, other) for other in jacobian[: a + 1]])
    y = solve_damped(lower, damping, residual)
    return blocked_matmul_columns(
        forward.root, np.einsum("an,acn->cn", np.stack(y), jacobian)
    )


def solve_damped(
    gram: Sequence[Sequence[Any]],
    damping: Any,
    right: Any,
    least_pivot: float = 1e-22,
) -> tuple[Any, Any, Any]:
    """Solve (G + μ tr(G) I) y = b for n symmetric positive G by L D Lᵀ; all elements
    are arrays (n,).

    ``gram`` is the lower half of G, row by row. A pivot that rounding made zero or
    negative is replaced by ``least_pivot`` of the trace, a millionth of an ulp. The
    step is then long, never NaN, and the caller's check of the residual rejects it.
    """
    (a00,), (a10, a11), (a20, a21, a22) = gram
    xp = a00.__array_namespace__()
    trace = a00 + a11 + a22
    shift = damping * trace
    floor = least_pivot * trace + 1e-300
    # G + μ tr(G) I = L D Lᵀ
    d0 = xp.maximum(a00 + shift, floor)
    l10 = a10 / d0
    l20 = a20 / d0
    d1 = xp.maximum(a11 + shift - l10 * a10, floor)
    l21 = (a21 - l20 * a10) / d1
    d2 = xp.maximum(a22 + shift - l20 * a20 - l21 * l21 * d1, floor)
    # L z = b, Lᵀ y = D⁻¹ z
    z0 = right[0]
    z1 = right[1] - l10 * z0
    z2 = right[2] - l20 * z0 - l21 * z1
    y2 = z2 / d2
    y1 = z1 / d1 - l21 * y2
    return z0 / d0 - l10 * y1 - l20 * y2, y1, y2
