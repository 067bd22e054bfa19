"""Conversion between trigonometric moments and multipliers of bounded maximum-entropy spectra.

`complex_moments` has the multipliers of signals on the full circle, `roots` the moments of nearly box-shaped spectra.

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
from uplift.models import complex_moments
from uplift.models.arithmetic import arctan
from uplift.models.roots import moments_by_roots

RealOrComplex = TypeVar("RealOrComplex", bound=Array | Complex)
"""Real for a mirrored signal, which is even in the phase; complex on the full circle."""

_FIRST_NODES = 48
_MAX_NODES = 96 << 6
_SAMPLES = 1 << 18
"""Samples in memory at a time."""
_ROWS = 1 << 12
"""Spectra per block; their temporary arrays fit into the cache."""
_GREY_WEIGHTS = (1e-10, 1e-8, 1e-6, 1e-4)
"""Weights of grey blended in, in turn, until the recursion succeeds."""


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
    """How spectra are integrated to moments: `integrate` or a faster equivalent.

    A spectrum has converged when doubling the nodes changes it by ``converged`` at most; the error is about the square.
    """

    integrate: Callable[[Array, Array, Array], Array] = integrate
    converged: float = 1e-8


PRECISE = Quadrature()


def moments_from_multipliers(multipliers: Array, quadrature: Quadrature = PRECISE) -> Array:
    """Moments (n, C) of the spectra of multipliers (n, C), by the trapezoid rule over the phase.

    The rule converges geometrically, so its error is about the square of the last change. The nodes are doubled for
    spectra that have not converged. Nearly box-shaped spectra would need too many nodes; `roots` handles them.
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
    """Multipliers (n, C) of the bounded maximum-entropy spectra with given moments (n, C), real or complex.

    Complex moments are (1/2π) ∫ g(φ) exp(−ijφ) dφ with a real zeroth moment, where g = ½ + arctan(Re Σ p_l w_l) / π and
    w is the `fourier_basis`. The moments of an even g are real.

    Near the boundary of the moment space the recursion breaks down. Such moments are blended with those of grey, with
    a weight of 1e−10 at first and at most 1e−4. Raises `UpliftError` for moments that no reflectance has.
    """
    grey = np.zeros_like(moments[:1])
    grey[:, 0] = 0.5
    multipliers, valid = try_dual(moments)
    for weight in _GREY_WEIGHTS:
        pending = np.flatnonzero(~valid)
        if not pending.size:
            return multipliers
        blend = (1 - weight) * moments[pending] + weight * grey
        multipliers[pending], valid[pending] = try_dual(blend)
    if valid.all():
        return multipliers
    raise UpliftError(
        f"{(~valid).sum()} sets of coefficients are not the moments of any reflectance",
        code="invalid-moments",
    )


def try_dual(moments: RealOrComplex) -> tuple[RealOrComplex, Mask]:
    """Compute the multipliers (n, C) of moments (n, C), and where (n,) they are valid: moments of a reflectance."""
    dual: Any = real_dual if np.isrealobj(moments) else complex_moments.dual
    multipliers, valid = np.empty_like(moments), np.empty(len(moments), dtype=bool)
    for first in range(0, len(moments), _ROWS):
        block = slice(first, first + _ROWS)
        multipliers[block], valid[block] = dual(moments[block])
    return multipliers, valid


def _rule(phase: Array, weights: Array, count: int) -> tuple[Array, Array]:
    """Return synthesis (C, K) and analysis (K, C) of a rule with K nodes and weights."""
    table = cosine_basis(phase, count)
    analysis = weights[:, None] * table
    analysis[:, 1:] /= 2
    return table.T, analysis


def _midpoints(nodes: int, count: int) -> tuple[Array, Array]:
    """Return the rule of the midpoints of K intervals."""
    return _rule(-np.pi * (np.arange(nodes) + 0.5) / nodes, np.full(nodes, 1 / nodes), count)


def _trapezoid_and_midpoints(nodes: int, count: int) -> tuple[Array, Array]:
    """Return synthesis (C, 2K + 1) and analysis (2K + 1, 2C) of both rules, whose moments stand side by side."""
    weights = np.full(nodes + 1, 1 / nodes)
    weights[[0, -1]] /= 2
    rules = (_rule(np.linspace(-np.pi, 0, nodes + 1), weights, count), _midpoints(nodes, count))
    synthesis = np.concatenate([rule[0] for rule in rules], axis=1)
    analysis = np.zeros((2 * nodes + 1, 2 * count))
    analysis[: nodes + 1, :count], analysis[nodes + 1 :, count:] = rules[0][1], rules[1][1]
    return synthesis, analysis


def real_dual(moments: Array) -> tuple[Array, Mask]:
    """Compute multipliers (n, C) of real moments (n, C), and their validity (n,).

    All reflection coefficients share one complex phase. Schur's algorithm (1917) therefore yields them from a real
    series, and the orthogonal polynomials follow from two real recursions: half of the operations of Levinson's
    recursion. Internally the order is the first axis, so that all arithmetic runs along contiguous spectra.
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
