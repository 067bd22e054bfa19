"""Moments of spectra as steep as boxes, in closed form (docs/mathematics.md, 4).

The linear part x is a polynomial of degree m in y = cos φ. With the roots y_k of x − i, and ζ_k the root within the
unit circle of ζ + 1/ζ = 2 y_k, log(1 + ix) is a constant less Σ_j (2/j) Σ_k ζ_k^j cos jφ; its imaginary part is
π (g − ½).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array

Complex = NDArray[np.complex128]

MAX_MULTIPLIER = 1e9
"""Multipliers beyond are held here: the spectra are the same to a billionth, and roots stay off the unit circle."""
LEAST_LEAD = 1e-14
"""A leading coefficient this small against the largest is rounding, and is held there: its roots are far away."""


def moments_by_roots(multipliers: Array) -> Array:
    """Moments (n, C) of the spectra with multipliers (n, C)."""
    held = multipliers * (
        MAX_MULTIPLIER / np.maximum(np.abs(multipliers).max(axis=1, keepdims=True), MAX_MULTIPLIER)
    )
    series = 2 * held.astype(complex)
    series[:, 0] = held[:, 0] - 1j
    largest = np.abs(series).max(axis=1)
    lead = series[:, -1]
    series[:, -1] = np.where(np.abs(lead) < LEAST_LEAD * largest, LEAST_LEAD * largest, lead)
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
    """(n, m, m) matrices whose eigenvalues are the roots of Chebyshev series (n, m + 1), m ≥ 2.

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
    """½ and the constant's argument by π: known up to 2, it lies in [0, 1]."""
    turns = 1 + (np.angle(lead) + np.angle(-outer).sum(axis=1)) / np.pi
    zeroth = turns % 2
    return np.clip(np.where(zeroth > 1.5, zeroth - 2, zeroth), 0, 1)
