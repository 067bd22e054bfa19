"""Conversion between trigonometric moments and multipliers of bounded maximum-entropy spectra.

`real_moments` and `complex_moments` compute multipliers; `roots` computes moments of nearly box-shaped spectra.

References
----------
Peters, Merzbach, Hanika & Dachsbacher 2019, "Using moments to represent bounded signals for spectral rendering",
ACM TOG 38(4). docs/mathematics.md, 4.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from uplift.common.arrays import Array, Complex, Mask
from uplift.common.errors import UpliftError
from uplift.models import complex_moments, real_moments
from uplift.models.arctan import arctan
from uplift.models.roots import moments_by_roots

RealOrComplex = TypeVar("RealOrComplex", bound=Array | Complex)
"""Real for a mirrored signal, which is even in the phase; complex on the full circle."""

_FIRST_NODES = 48
_MAX_NODES = 96 << 6
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


def integrate(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Integrate spectra to moments (n, C): samples by ``synthesis`` (C, K), weighted by ``analysis`` (K, C)."""
    moments = np.empty((len(multipliers), analysis.shape[1]))
    rows = max(_SAMPLES // len(analysis), 1)
    for first in range(0, len(multipliers), rows):
        block = slice(first, first + rows)
        moments[block] = (0.5 + arctan(multipliers[block] @ synthesis) / np.pi) @ analysis
    return moments


@dataclass(frozen=True)
class Quadrature:
    """How spectra are integrated to moments.

    Parameters
    ----------
    integrate : callable, default `integrate`
        `integrate`, or a faster equivalent.
    converged : float, default 1e-8
        Change by doubling the nodes at which a spectrum has converged. The error is about the square of it.
    """

    integrate: Callable[[Array, Array, Array], Array] = integrate
    converged: float = 1e-8


PRECISE = Quadrature()


def moments_from_multipliers(multipliers: Array, quadrature: Quadrature = PRECISE) -> Array:
    """Compute the moments of spectra by the trapezoid rule over the phase.

    The rule converges geometrically, so its error is about the square of the last change. The nodes are doubled for
    spectra that have not converged. Nearly box-shaped spectra would need too many nodes; `roots` handles them.

    Parameters
    ----------
    multipliers : ndarray, shape (n, C)
        Multipliers.
    quadrature : Quadrature
        How spectra are integrated.

    Returns
    -------
    ndarray, shape (n, C)
        Moments.
    """
    # T_2K = (T_K + M_K) / 2: the first rule and its midpoints together, then midpoints of those that need more.
    count, nodes = multipliers.shape[1], _FIRST_NODES
    found = quadrature.integrate(multipliers, *_trapezoid_and_midpoints(nodes, count))
    moments, change = found[:, :count].copy(), (found[:, count:] - found[:, :count]) / 2
    pending = np.arange(len(multipliers))
    while True:
        moments[pending] += change
        pending = pending[np.abs(change).max(axis=1) > quadrature.converged]
        nodes *= 2
        if not pending.size or nodes >= _MAX_NODES:
            break
        change = (quadrature.integrate(multipliers[pending], *_midpoints(nodes, count)) - moments[pending]) / 2
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
    grey = np.zeros_like(moments[:1])
    grey[:, 0] = 0.5
    multipliers, valid = try_dual(moments)
    for share in _GREY_SHARES:
        pending = np.flatnonzero(~valid)
        if not pending.size:
            return multipliers
        blend = (1 - share) * moments[pending] + share * grey
        multipliers[pending], valid[pending] = try_dual(blend)
    if valid.all():
        return multipliers
    raise UpliftError(
        f"{(~valid).sum()} sets of coefficients are not the moments of any reflectance",
        code="invalid-moments",
    )


def try_dual(moments: RealOrComplex) -> tuple[RealOrComplex, Mask]:
    """Compute the multipliers (n, C) of moments (n, C), and where (n,) they are valid: moments of a reflectance."""
    dual: Any = real_moments.dual if np.isrealobj(moments) else complex_moments.dual
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


def _trapezoid_and_midpoints(nodes: int, count: int) -> tuple[Array, Array]:
    """Return synthesis (C, 2K + 1) and analysis (2K + 1, 2C) of both rules, whose moments stand side by side."""
    rules = (_trapezoid(nodes, count), _midpoints(nodes, count))
    synthesis = np.concatenate([rule[0] for rule in rules], axis=1)
    analysis = np.zeros((2 * nodes + 1, 2 * count))
    analysis[: nodes + 1, :count], analysis[nodes + 1 :, count:] = rules[0][1], rules[1][1]
    return synthesis, analysis


def _analysis(table: Array, weights: Array) -> Array:
    projection = weights[:, None] * table
    projection[:, 1:] /= 2
    return projection
