"""Trigonometric moments ↔ multipliers of the bounded maximum-entropy spectrum (docs/mathematics.md, 4).

Peters, Merzbach, Hanika & Dachsbacher 2019, "Using moments to represent bounded signals for spectral
rendering", ACM TOG 38(4); Markoff 1896 for the duality between bounded and unbounded moment problems.
"""

from __future__ import annotations

from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from uplift.errors import UpliftError
from uplift.sensor import Array

Complex = NDArray[np.complex128]
RealOrComplex = TypeVar("RealOrComplex", bound=Array | Complex)
"""Real where the signal is mirrored, and so even in the phase; complex over the whole circle."""

_FIRST_NODES = 256
_MOST_NODES = 1 << 16
_HALF_AGREES = 1e-8
_BLOCK = 1 << 21
"""Samples held at a time."""
_INWARD = (0.0, 1e-10, 1e-8, 1e-6, 1e-4)


def cosines(phase: Array, count: int) -> Array:
    """(N, C) table of 1, 2 cos φ, …, 2 cos mφ: the linear part of the spectrum."""
    table = 2 * np.cos(phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def waves(phase: Array, count: int) -> Complex:
    """(N, C) table of 1, 2 exp(iφ), …, 2 exp(imφ): its real part with complex multipliers is the linear part."""
    table = 2 * np.exp(1j * phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def moments_from_multipliers(multipliers: Array) -> Array:
    """Moments (n, C) of the spectra with multipliers (n, C), by the trapezoid rule over the phase.

    The rule converges geometrically, so its error is about the square of what half its nodes miss; it is
    doubled for the spectra (those near a box) where that is not yet nothing.
    """
    moments = np.empty_like(multipliers)
    left = np.arange(len(multipliers))
    nodes = _FIRST_NODES
    while left.size and nodes <= _MOST_NODES:
        missed = np.empty(left.size)
        for block in np.array_split(np.arange(left.size), -(-left.size * nodes // _BLOCK)):
            moments[left[block]], missed[block] = _trapezoid(multipliers[left[block]], nodes)
        left = left[missed > _HALF_AGREES]
        nodes *= 2
    return moments


def multipliers_from_moments(moments: RealOrComplex) -> RealOrComplex:
    """Multipliers (n, C) of the bounded maximum-entropy spectra with moments (n, C), real or complex alike.

    Complex moments are (1/2π) ∫ g(φ) exp(−ijφ) dφ, the zeroth real; g = ½ + arctan(Re Σ p_l w_l) / π with
    w the `waves`. Real ones are those of an even g.

    Moments so near the boundary of the moment space that the recursion breaks down are blended with
    those of a grey, by 1e−10 at first and 1e−4 at the most.

    Raises
    ------
    UpliftError : no reflectance has these moments.
    """
    grey = np.zeros_like(moments[:1])
    grey[:, 0] = 0.5
    multipliers = np.empty_like(moments)
    left = np.arange(len(moments))
    for share in _INWARD:
        found, valid = _dual((1 - share) * moments[left] + share * grey)
        multipliers[left[valid]] = found[valid]
        left = left[~valid]
        if not left.size:
            return multipliers
    raise UpliftError(f"{len(left)} sets of coefficients are not the moments of any reflectance")


def levinson(column: Complex) -> tuple[Complex, NDArray[np.bool_]]:
    """Solve T q = e₀ for Hermitian Toeplitz T with first ``column`` (n, C); also say where T is positive.

    Levinson's recursion: a solution of order k, padded, plus its own mirror image, solves order k + 1.
    """
    solution = 1 / column[:, :1]
    positive = column[:, 0].real > 0
    zero = np.zeros_like(solution)
    for order in range(1, column.shape[1]):
        spill = (column[:, order:0:-1] * solution).sum(axis=1, keepdims=True)
        mirror = np.concatenate([zero, solution[:, ::-1].conj()], axis=1)
        margin = 1 - np.abs(spill) ** 2
        positive &= margin[:, 0] > 0
        solution = (np.concatenate([solution, zero], axis=1) - spill * mirror) / margin
    return solution, positive


def _trapezoid(multipliers: Array, nodes: int) -> tuple[Array, Array]:
    """Moments (n, C) by ``nodes`` intervals, and by how much (n,) half as many differ."""
    table = cosines(np.linspace(-np.pi, 0, nodes + 1), multipliers.shape[1])
    samples = 0.5 + np.arctan(multipliers @ table.T) / np.pi
    moments, coarse = (samples[:, ::step] @ _projection(table[::step]) for step in (1, 2))
    return moments, np.abs(moments - coarse).max(axis=1)


def _projection(table: Array) -> Array:
    """(K + 1, C) weights that take samples at evenly spaced phases to moments."""
    weights = np.full(len(table), 1 / (len(table) - 1))
    weights[[0, -1]] /= 2
    projection = weights[:, None] * table
    projection[:, 1:] /= 2
    return projection


def _dual(moments: RealOrComplex) -> tuple[RealOrComplex, NDArray[np.bool_]]:
    """Multipliers by docs/mathematics.md, 4, and where they can be trusted."""
    with np.errstate(all="ignore"):
        # The dual knows the zeroth moment only up to whole numbers.
        bounded = (moments[:, 0].real >= 0) & (moments[:, 0].real <= 1)
        exponential = _exponential_moments(moments)
        column = exponential / 2
        column[:, 0] = exponential[:, 0].real
        q, positive = levinson(column)
        found = _bounded(exponential, q)
        multipliers = cast(RealOrComplex, found.real if np.isrealobj(moments) else found)
    return multipliers, bounded & positive & np.isfinite(multipliers).all(axis=1)


def _exponential_moments(moments: RealOrComplex) -> Complex:
    h = np.empty(moments.shape, dtype=complex)
    h[:, 0] = np.exp(1j * np.pi * (moments[:, 0].real - 0.5))
    for order in range(1, moments.shape[1]):
        steps = np.arange(order, 0, -1)
        h[:, order] = 2j * np.pi / order * (steps * moments[:, order:0:-1] * h[:, :order]).sum(axis=1)
    return h


def _bounded(h: Complex, q: Complex) -> Complex:
    count = h.shape[1]
    n = np.stack([(h[:, : k + 1] * q[:, k::-1]).sum(axis=1) for k in range(count)], axis=1)
    lags = [(n[:, lag:] * q[:, : count - lag].conj()).sum(axis=1) for lag in range(count)]
    multipliers = np.stack(lags, axis=1) / (1j * q[:, :1])
    multipliers[:, 0] = multipliers[:, 0].real
    return multipliers
