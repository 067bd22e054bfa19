"""Trigonometric moments ↔ multipliers of the bounded maximum-entropy spectrum (docs/mathematics.md, 4).

`circle` and `mirrored` have the dual of complex and of real moments; `roots` the moments of near boxes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.models import complex_moments, real_moments
from uplift.models.arctan import arctan
from uplift.models.roots import moments_by_roots

Complex = NDArray[np.complex128]
RealOrComplex = TypeVar("RealOrComplex", bound=Array | Complex)
"""Real where the signal is mirrored, and so even in the phase; complex over the whole circle."""

_FIRST_NODES = 32
_MOST_NODES = 1 << 12
_HALF_AGREES = 1e-8
_SAMPLES = 1 << 18
"""Samples held at a time."""
_ROWS = 1 << 12
"""Spectra worked on at a time: what one needs stays in the cache."""
_INWARD = (1e-10, 1e-8, 1e-6, 1e-4)


def cosine_basis(phase: Array, count: int) -> Array:
    """(N, C) table of 1, 2 cos φ, …, 2 cos mφ: the linear part of the spectrum."""
    table = 2 * np.cos(phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def fourier_basis(phase: Array, count: int) -> Complex:
    """(N, C) table of 1, 2 exp(iφ), …, 2 exp(imφ): its real part with complex multipliers is the linear part."""
    table = 2 * np.exp(1j * phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def quadrature(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Moments (n, C): samples of the spectra by ``synthesis`` (C, K), weighted by ``analysis`` (K, C)."""
    moments = np.empty((len(multipliers), analysis.shape[1]))
    rows = max(_SAMPLES // len(analysis), 1)
    for first in range(0, len(multipliers), rows):
        block = slice(first, first + rows)
        moments[block] = (0.5 + arctan(multipliers[block] @ synthesis) / np.pi) @ analysis
    return moments


Quadrature = Callable[[Array, Array, Array], Array]
"""`quadrature`, or a quicker one."""


def moments_from_multipliers(multipliers: Array, quadrature: Quadrature = quadrature) -> Array:
    """Moments (n, C) of the spectra with multipliers (n, C), by the trapezoid rule over the phase.

    The rule converges geometrically, so its error is about the square of what half its nodes miss; nodes
    are put between those there for the spectra where that is not yet nothing. What is as steep as a box takes too
    many: that is done by `roots`.
    """
    count, nodes = multipliers.shape[1], _FIRST_NODES
    moments = quadrature(multipliers, *_trapezoid(nodes, count))
    left = np.arange(len(multipliers))
    while left.size and nodes < _MOST_NODES:
        change = (quadrature(multipliers[left], *_midpoints(nodes, count)) - moments[left]) / 2
        moments[left] += change
        left = left[np.abs(change).max(axis=1) > _HALF_AGREES]
        nodes *= 2
    if left.size:
        moments[left] = moments_by_roots(multipliers[left])
    return moments


def multipliers_from_moments(moments: RealOrComplex) -> RealOrComplex:
    """Multipliers (n, C) of the bounded maximum-entropy spectra with moments (n, C), real or complex alike.

    Complex moments are (1/2π) ∫ g(φ) exp(−ijφ) dφ, the zeroth real; g = ½ + arctan(Re Σ p_l w_l) / π with
    w the `fourier_basis`. Real ones are those of an even g.

    Moments so near the boundary of the moment space that the recursion breaks down are blended with
    those of a grey, by 1e−10 at first and 1e−4 at the most.

    Raises
    ------
    UpliftError : no reflectance has these moments.
    """
    dual = real_moments.dual if np.isrealobj(moments) else complex_moments.dual
    grey = np.zeros_like(moments[:1])
    grey[:, 0] = 0.5
    multipliers, valid = _by_blocks(dual, moments)
    for share in _INWARD:
        left = np.flatnonzero(~valid)
        if not left.size:
            return multipliers
        multipliers[left], valid[left] = _by_blocks(dual, (1 - share) * moments[left] + share * grey)
    if valid.all():
        return multipliers
    raise UpliftError(f"{(~valid).sum()} sets of coefficients are not the moments of any reflectance")


def _by_blocks(dual: Any, moments: RealOrComplex) -> tuple[RealOrComplex, NDArray[np.bool_]]:
    multipliers, valid = np.empty_like(moments), np.empty(len(moments), dtype=bool)
    for first in range(0, len(moments), _ROWS):
        part = slice(first, first + _ROWS)
        multipliers[part], valid[part] = dual(moments[part])
    return multipliers, valid


def _trapezoid(nodes: int, count: int) -> tuple[Array, Array]:
    """Samples of the linear part (C, K + 1) and weights (K + 1, C) that take spectra there to moments."""
    table = cosine_basis(np.linspace(-np.pi, 0, nodes + 1), count)
    weights = np.full(nodes + 1, 1 / nodes)
    weights[[0, -1]] /= 2
    return table.T, _analysis(table, weights)


def _midpoints(nodes: int, count: int) -> tuple[Array, Array]:
    """The same, (C, K) and (K, C), for the middles between the nodes."""
    table = cosine_basis(-np.pi * (np.arange(nodes) + 0.5) / nodes, count)
    return table.T, _analysis(table, np.full(nodes, 1 / nodes))


def _analysis(table: Array, weights: Array) -> Array:
    projection = weights[:, None] * table
    projection[:, 1:] /= 2
    return projection
