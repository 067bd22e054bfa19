"""Multipliers of real moments: the moments of an even signal, in real arithmetic (docs/mathematics.md, 4).

All reflection coefficients share one complex phase. Schur's algorithm therefore yields them from a real series, and the
orthogonal polynomials follow from two real recursions. This takes half of the operations of Levinson's recursion.

References
----------
Schur 1917, "Über Potenzreihen, die im Innern des Einheitskreises beschränkt sind".
"""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Mask


def dual(moments: Array) -> tuple[Array, Mask]:
    """Compute multipliers (n, C) of moments (n, C), and their validity (n,).

    Internally the order is the first axis, so that all arithmetic runs along contiguous spectra.
    """
    orders = np.ascontiguousarray(moments.T)
    zeroth = orders[0]
    with np.errstate(all="ignore"):
        # The series determines the zeroth moment only up to integers.
        bounded = (zeroth >= 0) & (zeroth <= 1)
        polynomials, scale, positive = _recursion(*_series(orders))
        tangent = np.tan(np.pi / 2 * zeroth)
        polynomials *= np.sqrt(np.stack([tangent, 1 / tangent]) / (2 * scale))
        # p_l is the coefficient of (τ |A|² − |B|² / τ) / 2κ at lag l, with τ = tan(π c₀ / 2) and κ = Π (1 − g²).
        multipliers = np.empty_like(orders)
        for lag, row in enumerate(multipliers):
            first, second = np.einsum("kpn,kpn->pn", polynomials[lag:], polynomials[: len(orders) - lag])
            row[:] = first - second
    return multipliers.T, bounded & positive & np.isfinite(multipliers).all(axis=0)


def _series(moments: Array) -> tuple[Array, Array]:
    """Compute the series (m, n) of sin X / z and sin(π c₀ + X), X = π Σ_l c_l z^l, of moments (m + 1, n).

    Both are parts of exp(iX), whose terms follow from its derivative iX' exp(iX), order by order.
    """
    count, spectra = moments.shape
    slopes = np.pi * np.arange(count)[:, None] * moments
    parts = np.empty((count, 2, spectra))
    parts[0, 0], parts[0, 1] = 1, 0
    for order in range(1, count):
        np.einsum("kn,kpn->pn", slopes[order:0:-1], parts[:order, ::-1], out=parts[order])
        parts[order, 0] /= -order
        parts[order, 1] /= order
    cosine, sine = parts[:, 0], parts[:, 1]
    angle = np.pi * moments[0]
    return sine[1:], np.sin(angle) * cosine[:-1] + np.cos(angle) * sine[:-1]


def _recursion(upper: Array, lower: Array) -> tuple[Array, Array, Mask]:
    """Compute polynomials A and B (C, 2, n), Π (1 − g²) (n,), and whether (n,) all |g| < 1, of ``upper / lower``.

    Each g is the first term of the quotient; the remainder is a quotient again, one order shorter.
    """
    count, spectra = upper.shape
    polynomials = np.zeros((count + 1, 2, spectra))
    polynomials[0] = 1
    scale, positive = np.ones(spectra), np.ones(spectra, dtype=bool)
    for order in range(count):
        g = upper[0] / lower[0]
        upper, lower = upper[1:] - g * lower[1:], lower[:-1] - g * upper[:-1]
        polynomials[1 : order + 2] += np.stack([g, -g]) * polynomials[order::-1]
        factor = 1 - g * g
        scale *= factor
        positive &= factor > 0
    return polynomials, scale, positive
