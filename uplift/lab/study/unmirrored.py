"""Conversion between complex trigonometric moments and multipliers, of signals that are
not mirrored: `uplift.models.duality` for a real signal on the whole circle.

Peters, Merzbach, Hanika & Dachsbacher 2019, "Using moments to represent bounded signals
for spectral rendering", ACM TOG 38(4).
"""

import numpy as np

from uplift.common.arrays import Array, Complex, Mask


def fourier_basis(phase: Array, count: int) -> Complex:
    """Tabulate 1, 2 exp(iφ), …, 2 exp(imφ) as (N, C); with complex multipliers, its
    real part is the linear part.
    """
    table = 2 * np.exp(1j * phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def try_complex_multipliers(moments: Complex) -> tuple[Complex, Mask]:
    """Multipliers (n, C) of moments (n, C), and where (n,) they are valid.

    Complex moments are (1/2π) ∫ g(φ) exp(−ijφ) dφ with a real zeroth moment, where g =
    ½ + arctan(Re Σ p_l w_l) / π and w is the `fourier_basis`. Those of an even g are
    real, and `uplift.models.duality.try_multipliers` needs half of the operations.
    Internally the order is the first axis, so that all arithmetic runs along contiguous
    spectra.
    """
    orders = np.ascontiguousarray(moments.T)
    with np.errstate(all="ignore"):
        # The recursion determines the zeroth moment only up to integers.
        bounded = (orders[0].real >= 0) & (orders[0].real <= 1)
        h = _exponential_moments(orders)
        # T q = e₀ with the Toeplitz matrix of a_0 = Re h_0, a_l = h_l / 2; p_l = (1 / i
        # q_0) Σ_k n_{k+l} q̄_k
        column = h / 2
        column[0] = h[0].real
        q, scale, positive = levinson(column)
        n = np.stack([(h[: k + 1] * q[k::-1]).sum(axis=0) for k in range(len(h))])
        mirror = q.conj() / (1j * scale)
        multipliers = np.stack(
            [(n[lag:] * mirror[: len(n) - lag]).sum(axis=0) for lag in range(len(n))]
        )
        multipliers[0] = multipliers[0].real
    return multipliers.T, bounded & positive & np.isfinite(multipliers).all(axis=0)


def _exponential_moments(moments: Complex) -> Complex:
    h = np.empty_like(moments)
    h[0] = np.exp(1j * np.pi * (moments[0].real - 0.5))
    scaled = 2j * np.pi * np.arange(len(moments))[:, None] * moments
    for order in range(1, len(moments)):
        h[order] = (scaled[order:0:-1] * h[:order]).sum(axis=0) / order
    return h


def levinson(column: Complex) -> tuple[Complex, Array, Mask]:
    """Solve T q = e₀ for Hermitian Toeplitz matrices T with first ``column`` (C, n), by
    Levinson's recursion.

    In Durbin's form, a solution of order k + 1 combines the padded solution of order k
    with its mirror image. Returns q / q_0 (C, n), 1 / q_0 (n,), and where (n,) T is
    positive definite.
    """
    solution = np.zeros_like(column)
    solution[0] = 1
    scale = column[0].real.copy()
    positive = scale > 0
    for order in range(1, len(column)):
        reflection = (column[order:0:-1] * solution[:order]).sum(axis=0) / scale
        mirror = solution[order - 1 :: -1].conj()
        solution[1 : order + 1] -= reflection * mirror
        scale *= 1 - (reflection.real**2 + reflection.imag**2)
        positive &= scale > 0
    return solution, scale, positive
