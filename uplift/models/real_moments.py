"""The dual of real moments, those of an even signal: half of Levinson's recursion, and no complex number.

docs/mathematics.md, 4: the reflection coefficients of the whole circle share one phase there, so that they come from
a real series, by Schur's algorithm, and the orthogonal polynomials from two real recursions.
Schur 1917, "Über Potenzreihen, die im Innern des Einheitskreises beschränkt sind".
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array


def dual(moments: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Multipliers (n, C) of moments (n, C), and where (n,) they can be trusted.

    Inside, the order comes first, so that all arithmetic runs along contiguous spectra.
    """
    orders = np.ascontiguousarray(moments.T)
    zeroth = orders[0]
    with np.errstate(all="ignore"):
        # The series knows the zeroth moment only up to whole numbers.
        bounded = (zeroth >= 0) & (zeroth <= 1)
        polynomials, scale, positive = _recursion(*_series(orders))
        tangent = np.tan(np.pi / 2 * zeroth)
        polynomials *= np.sqrt(np.stack([tangent, 1 / tangent]) / (2 * scale))
        multipliers = np.empty_like(orders)
        for lag, found in enumerate(multipliers):
            first, second = np.einsum("kpn,kpn->pn", polynomials[lag:], polynomials[: len(orders) - lag])
            found[:] = first - second
    return multipliers.T, bounded & positive & np.isfinite(multipliers).all(axis=0)


def _series(moments: Array) -> tuple[Array, Array]:
    """Series (m, n) of sin X / z and of sin(π c₀ + X), X = π Σ_l c_l z^l, of moments (m + 1, n).

    Both are parts of exp(iX), which follows order by order from its derivative, iX' exp(iX).
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


def _recursion(upper: Array, lower: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Polynomials A and B (C, 2, n), Π (1 − g²) (n,), and whether (n,) all |g| < 1; g are those of ``upper / lower``.

    Each g is the first term of the quotient; what is left of it is a quotient again, one order shorter.
    """
    count, spectra = upper.shape
    polynomials = np.zeros((count + 1, 2, spectra))
    polynomials[0] = 1
    scale, positive = np.ones(spectra), np.ones(spectra, dtype=bool)
    for order in range(count):
        g = upper[0] / lower[0]
        upper, lower = upper[1:] - g * lower[1:], lower[:-1] - g * upper[:-1]
        polynomials[1 : order + 2] += np.stack([g, -g]) * polynomials[order::-1]
        left = 1 - g * g
        scale *= left
        positive &= left > 0
    return polynomials, scale, positive
