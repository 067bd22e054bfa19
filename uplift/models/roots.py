"""Moments of nearly box-shaped spectra in closed form (docs/mathematics.md, 4).

The linear part x is a polynomial of degree m in y = cos φ. Let y_k be the roots of x − i, and ζ_k the root of
ζ + 1/ζ = 2 y_k inside the unit circle. Then log(1 + ix) is a constant minus Σ_j (2/j) Σ_k ζ_k^j cos jφ, and its
imaginary part is π (g − ½).
"""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Complex

MAX_MULTIPLIER = 1e9
"""Larger multipliers are scaled down to this: spectra change by a billionth, and roots stay off the unit circle."""
MIN_LEADING = 1e-14
"""Smallest leading coefficient relative to the largest; smaller ones are rounding errors with remote roots."""


def moments_by_roots(multipliers: Array) -> Array:
    """Compute moments (n, C) of the spectra with multipliers (n, C)."""
    magnitude = np.abs(multipliers).max(axis=1, keepdims=True)
    limited = multipliers * (MAX_MULTIPLIER / np.maximum(magnitude, MAX_MULTIPLIER))
    series = 2 * limited.astype(complex)
    series[:, 0] = limited[:, 0] - 1j
    largest = np.abs(series).max(axis=1)
    lead = series[:, -1]
    series[:, -1] = np.where(np.abs(lead) < MIN_LEADING * largest, MIN_LEADING * largest, lead)
    y = np.linalg.eigvals(_colleague(series))
    root = np.sqrt(y - 1) * np.sqrt(y + 1)
    outer = np.where(np.abs(y + root) >= np.abs(y - root), y + root, y - root)
    moments = np.empty_like(multipliers)
    moments[:, 0] = _zeroth(series[:, -1], outer)
    power = np.ones_like(outer)
    for order in range(1, multipliers.shape[1]):
        power = power / outer
        moments[:, order] = -power.sum(axis=1).imag / (np.pi * order)
    return moments


def _colleague(series: Complex) -> Complex:
    """Create the matrices (n, m, m) whose eigenvalues are the roots of Chebyshev series (n, m + 1), m ≥ 2.

    Good 1961, "The colleague matrix, a Chebyshev analogue of the companion matrix".
    """
    size = series.shape[1] - 1
    matrix = np.zeros((len(series), size, size), dtype=complex)
    order = np.arange(size - 1)
    matrix[:, order, order + 1] = 0.5
    matrix[:, order + 1, order] = 0.5
    matrix[:, 0, 1] = 1
    matrix[:, -1] -= series[:, :-1] / series[:, -1:] / 2
    return matrix


def _zeroth(lead: Complex, outer: Complex) -> Array:
    """½ plus the argument of the constant over π, which is known modulo 2 and lies in [0, 1]."""
    turns = 1 + (np.angle(lead) + np.angle(-outer).sum(axis=1)) / np.pi
    zeroth = turns % 2
    return np.clip(np.where(zeroth > 1.5, zeroth - 2, zeroth), 0, 1)
