"""Conversion between trigonometric moments and multipliers of bounded maximum-entropy spectra.

`real_moments` and `complex_moments` compute multipliers; `roots` computes moments of nearly box-shaped spectra.

References
----------
Peters, Merzbach, Hanika & Dachsbacher 2019, "Using moments to represent bounded signals for spectral rendering",
ACM TOG 38(4). docs/mathematics.md, 4.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from uplift.common.arrays import Array, Complex, Mask
from uplift.common.errors import UpliftError
from uplift.models import complex_moments, real_moments
from uplift.models.arctan import arctan
from uplift.models.roots import moments_by_roots

RealOrComplex = TypeVar("RealOrComplex", bound=Array | Complex)
"""Real for a mirrored signal, which is even in the phase; complex on the full circle."""

_FIRST_NODES = 32
_MAX_NODES = 1 << 12
_CONVERGED = 1e-8
"""Change by doubling the nodes at which the rule has converged."""
_SAMPLES = 1 << 18
"""Samples in memory at a time."""
_ROWS = 1 << 12
"""Spectra per block; their temporary arrays fit into the cache."""
_GREY_SHARES = (1e-10, 1e-8, 1e-6, 1e-4)
"""Shares of grey blended in, in turn, until the recursion succeeds."""


def cosine_basis(phase: Array, count: int) -> Array:
    """Tabulate 1, 2 cos φ, …, 2 cos mφ as (N, C): the basis of the linear part."""
    table = 2 * np.cos(phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def fourier_basis(phase: Array, count: int) -> Complex:
    """Tabulate 1, 2 exp(iφ), …, 2 exp(imφ) as (N, C); with complex multipliers, its real part is the linear part."""
    table = 2 * np.exp(1j * phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def quadrature(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Integrate spectra to moments (n, C): samples by ``synthesis`` (C, K), weighted by ``analysis`` (K, C)."""
    moments = np.empty((len(multipliers), analysis.shape[1]))
    rows = max(_SAMPLES // len(analysis), 1)
    for first in range(0, len(multipliers), rows):
        block = slice(first, first + rows)
        moments[block] = (0.5 + arctan(multipliers[block] @ synthesis) / np.pi) @ analysis
    return moments


Quadrature = Callable[[Array, Array, Array], Array]
"""`quadrature`, or a faster equivalent."""


def moments_from_multipliers(multipliers: Array, quadrature: Quadrature = quadrature) -> Array:
    """Compute the moments of spectra by the trapezoid rule over the phase.

    The rule converges geometrically, so its error is about the square of the last change. The nodes are doubled for
    spectra that have not converged. Nearly box-shaped spectra would need too many nodes; `roots` handles them.

    Parameters
    ----------
    multipliers : ndarray, shape (n, C)
        Multipliers.
    quadrature : callable
        Integrates spectra over given nodes.

    Returns
    -------
    ndarray, shape (n, C)
        Moments.
    """
    count, nodes = multipliers.shape[1], _FIRST_NODES
    moments = quadrature(multipliers, *_trapezoid(nodes, count))
    pending = np.arange(len(multipliers))
    while pending.size and nodes < _MAX_NODES:
        change = (quadrature(multipliers[pending], *_midpoints(nodes, count)) - moments[pending]) / 2
        moments[pending] += change
        pending = pending[np.abs(change).max(axis=1) > _CONVERGED]
        nodes *= 2
    if pending.size:
        moments[pending] = moments_by_roots(multipliers[pending])
    return moments


def multipliers_from_moments(moments: RealOrComplex) -> RealOrComplex:
    """Compute the multipliers of the bounded maximum-entropy spectra with given moments.

    Complex moments are (1/2π) ∫ g(φ) exp(−ijφ) dφ with a real zeroth moment, where g = ½ + arctan(Re Σ p_l w_l) / π and
    w is the `fourier_basis`. The moments of an even g are real.

    Near the boundary of the moment space the recursion breaks down. Such moments are blended with those of grey, with
    a share of 1e−10 at first and at most 1e−4.

    Parameters
    ----------
    moments : ndarray, shape (n, C)
        Moments, real or complex.

    Returns
    -------
    ndarray, shape (n, C)
        Multipliers.

    Raises
    ------
    UpliftError
        No reflectance has these moments.
    """
    dual = real_moments.dual if np.isrealobj(moments) else complex_moments.dual
    grey = np.zeros_like(moments[:1])
    grey[:, 0] = 0.5
    multipliers, valid = _by_blocks(dual, moments)
    for share in _GREY_SHARES:
        pending = np.flatnonzero(~valid)
        if not pending.size:
            return multipliers
        blend = (1 - share) * moments[pending] + share * grey
        multipliers[pending], valid[pending] = _by_blocks(dual, blend)
    if valid.all():
        return multipliers
    raise UpliftError(
        f"{(~valid).sum()} sets of coefficients are not the moments of any reflectance",
        code="invalid-moments",
    )


def _by_blocks(dual: Any, moments: RealOrComplex) -> tuple[RealOrComplex, Mask]:
    multipliers, valid = np.empty_like(moments), np.empty(len(moments), dtype=bool)
    for first in range(0, len(moments), _ROWS):
        block = slice(first, first + _ROWS)
        multipliers[block], valid[block] = dual(moments[block])
    return multipliers, valid


def _trapezoid(nodes: int, count: int) -> tuple[Array, Array]:
    """Return synthesis (C, K + 1) and analysis (K + 1, C) of the trapezoid rule with K intervals."""
    table = cosine_basis(np.linspace(-np.pi, 0, nodes + 1), count)
    weights = np.full(nodes + 1, 1 / nodes)
    weights[[0, -1]] /= 2
    return table.T, _analysis(table, weights)


def _midpoints(nodes: int, count: int) -> tuple[Array, Array]:
    """Return synthesis (C, K) and analysis (K, C) of the midpoints of the K intervals."""
    table = cosine_basis(-np.pi * (np.arange(nodes) + 0.5) / nodes, count)
    return table.T, _analysis(table, np.full(nodes, 1 / nodes))


def _analysis(table: Array, weights: Array) -> Array:
    projection = weights[:, None] * table
    projection[:, 1:] /= 2
    return projection
