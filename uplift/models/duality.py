"""Conversion between trigonometric moments and multipliers of bounded maximum-entropy
spectra.

References
----------
Peters, Merzbach, Hanika & Dachsbacher 2019, "Using moments to represent bounded signals
for spectral rendering", ACM TOG 38(4). docs/mathematics.md, 4.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Complex, Mask, blocks, largest
from uplift.common.errors import UpliftError
from uplift.common.text import pluralise
from uplift.models.arithmetic import arctan

MAX_MULTIPLIER = 1e9
"""Larger multipliers are scaled down to this: spectra change by a billionth, and roots
stay off the unit circle.
"""
MIN_LEADING = 1e-14
"""Smallest leading coefficient relative to the largest; smaller ones are rounding
errors with remote roots.
"""
CONVERGED = 1e-8
"""Change of moments by another doubling of the nodes at which a spectrum has converged.
"""
_FIRST_NODES = 48
_MAX_NODES = 96 << 6
_SAMPLES = 1 << 18
"""Samples in memory at a time."""
_ROWS = 1 << 13
"""Spectra per block; their temporary arrays fit into the cache."""
_GREY_WEIGHTS = (1e-10, 1e-8, 1e-6, 1e-4)
"""Weights of grey blended in, in turn, until the recursion succeeds."""


def cosine_basis(phase: Array, count: int) -> Array:
    """Tabulate 1, 2 cos φ, …, 2 cos mφ as (N, C): the basis of the linear part."""
    table = 2 * np.cos(phase[:, None] * np.arange(count))
    table[:, 0] = 1
    return table


def integrate(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Integrate spectra of multipliers (n, C) to (n, M): samples by ``synthesis`` (C,
    K), times ``analysis`` (K, M).
    """
    moments = np.empty((len(multipliers), analysis.shape[1]))
    for block in blocks(len(multipliers), max(_SAMPLES // len(analysis), 1)):
        moments[block] = (
            0.5 + arctan(multipliers[block] @ synthesis) / np.pi
        ) @ analysis
    return moments


def moments_from_multipliers(
    multipliers: Array,
    integrate: Callable[[Array, Array, Array], Array] = integrate,
    converged: float = CONVERGED,
) -> Array:
    """Moments (n, C) of the spectra of multipliers (n, C), by the trapezoid rule over
    the phase.

    The rule converges geometrically, so its error is about the square of the last
    change. The nodes are doubled for spectra that still change by more than
    ``converged``. Nearly box-shaped ones would need too many nodes; `moments_by_roots`
    handles them. ``integrate`` may be a faster equivalent of `integrate`.
    """
    # T_2K = (T_K + M_K) / 2: the first rule and its midpoints together, then midpoints
    # of those that need more.
    count = multipliers.shape[1]
    nodes = _FIRST_NODES
    both = integrate(multipliers, *_rule(nodes, count, with_trapezoid=True))
    moments = both[:, :count].copy()
    change = (both[:, count:] - both[:, :count]) / 2
    pending = np.arange(len(multipliers))
    while True:
        moments[pending] += change
        pending = pending[largest(np.abs(change)) > converged]
        nodes *= 2
        if not pending.size or nodes >= _MAX_NODES:
            break
        change = (
            integrate(multipliers[pending], *_rule(nodes, count)) - moments[pending]
        ) / 2
    if pending.size:
        moments[pending] = moments_by_roots(multipliers[pending])
    return moments


def _rule(nodes: int, count: int, with_trapezoid: bool = False) -> tuple[Array, Array]:
    """Return synthesis (C, K) and analysis (K, C) of the midpoints of K intervals.

    With the trapezoid rule, of 2 K + 1 nodes and 2 C moments: those of the trapezoid
    rule, then those of the midpoints.
    """
    phase = -np.pi * (np.arange(nodes) + 0.5) / nodes
    weights = np.full(nodes, 1 / nodes)
    if with_trapezoid:
        ends = np.full(nodes + 1, 1 / nodes)
        ends[[0, -1]] /= 2
        phase = np.append(np.linspace(-np.pi, 0, nodes + 1), phase)
        weights = np.append(ends, weights)
    table = cosine_basis(phase, count)
    # c_j = (1/π) ∫ g cos jφ dφ over [−π, 0]
    analysis = weights[:, None] * table
    analysis[:, 1:] /= 2
    if with_trapezoid:
        midpoint = np.arange(len(phase))[:, None] > nodes
        analysis = np.concatenate(
            [np.where(midpoint, 0, analysis), np.where(midpoint, analysis, 0)], axis=1
        )
    return table.T, analysis


def moments_by_roots(multipliers: Array) -> Array:
    """Compute moments (n, C) of nearly box-shaped spectra with multipliers (n, C), in
    closed form.

    The linear part x is a polynomial of degree m in y = cos φ. Let y_k be the roots of
    x − i, and ζ_k the root of ζ + 1/ζ = 2 y_k inside the unit circle. Then log(1 + ix)
    is a constant minus Σ_j (2/j) Σ_k ζ_k^j cos jφ, and its imaginary part is π (g − ½).
    """
    magnitude = np.abs(multipliers).max(axis=1, keepdims=True)
    limited = multipliers * (MAX_MULTIPLIER / np.maximum(magnitude, MAX_MULTIPLIER))
    series = 2 * limited.astype(complex)
    series[:, 0] = limited[:, 0] - 1j
    largest = np.abs(series).max(axis=1)
    lead = series[:, -1]
    series[:, -1] = np.where(
        np.abs(lead) < MIN_LEADING * largest, MIN_LEADING * largest, lead
    )
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
    """Create the matrices (n, m, m) whose eigenvalues are the roots of Chebyshev series
    (n, m + 1), m ≥ 2.

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
    """½ plus the argument of the constant over π, which is known modulo 2 and lies in
    [0, 1].
    """
    turns = 1 + (np.angle(lead) + np.angle(-outer).sum(axis=1)) / np.pi
    zeroth = turns % 2
    return np.clip(np.where(zeroth > 1.5, zeroth - 2, zeroth), 0, 1)


def try_multipliers(moments: Array) -> tuple[Array, Mask]:
    """Multipliers (n, C) of moments (n, C), and where (n,) they are valid: moments of a
    reflectance.

    All reflection coefficients share one complex phase. Schur's algorithm (1917)
    therefore yields them from a real series, and the orthogonal polynomials follow from
    two real recursions: half of the operations of Levinson's recursion. Internally the
    order is the first axis, so that all arithmetic runs along contiguous spectra.
    """
    multipliers = np.empty_like(moments)
    valid = np.empty(len(moments), dtype=bool)
    for block in blocks(len(moments), _ROWS):
        orders = np.ascontiguousarray(moments[block].T)
        zeroth = orders[0]
        with np.errstate(all="ignore"):
            # The series determines the zeroth moment only up to integers.
            bounded = (zeroth >= 0) & (zeroth <= 1)
            polynomials, scale, positive = _recursion(*_series(orders))
            # x = (τ |A|² − |B|² / τ) / 2κ with τ = tan(π c₀ / 2) and κ = Π (1 − g²)
            tangent = np.tan(np.pi / 2 * zeroth)
            polynomials *= np.sqrt(np.stack([tangent, 1 / tangent]) / (2 * scale))
            # p_l is the coefficient of x at lag l.
            for lag, row in enumerate(multipliers[block].T):
                first_part, second_part = np.einsum(
                    "kpn,kpn->pn", polynomials[lag:], polynomials[: len(orders) - lag]
                )
                row[:] = first_part - second_part
        valid[block] = bounded & positive & np.isfinite(multipliers[block]).all(axis=1)
    return multipliers, valid


def _series(moments: Array) -> tuple[Array, Array]:
    """Compute the series (m, n) of sin X / z and sin(π c₀ + X), X = π Σ_l c_l z^l, of
    moments (m + 1, n).

    Both are parts of exp(iX), whose terms follow from its derivative iX' exp(iX), order
    by order.
    """
    count, spectra = moments.shape
    slopes = np.pi * np.arange(count)[:, None] * moments
    parts = np.empty((count, 2, spectra))
    parts[0, 0] = 1
    parts[0, 1] = 0
    for order in range(1, count):
        np.einsum(
            "kn,kpn->pn", slopes[order:0:-1], parts[:order, ::-1], out=parts[order]
        )
        parts[order, 0] /= -order
        parts[order, 1] /= order
    cosine = parts[:, 0]
    sine = parts[:, 1]
    angle = np.pi * moments[0]
    return sine[1:], np.sin(angle) * cosine[:-1] + np.cos(angle) * sine[:-1]


def _recursion(upper: Array, lower: Array) -> tuple[Array, Array, Mask]:
    """Compute polynomials A and B (C, 2, n), Π (1 − g²) (n,), and whether (n,) all |g|
    < 1, of ``upper / lower``.

    Each g is the first term of the quotient; the remainder is a quotient again, one
    order shorter.
    """
    count, spectra = upper.shape
    polynomials = np.zeros((count + 1, 2, spectra))
    polynomials[0] = 1
    scale = np.ones(spectra)
    positive = np.ones(spectra, dtype=bool)
    for order in range(count):
        g = upper[0] / lower[0]
        upper, lower = upper[1:] - g * lower[1:], lower[:-1] - g * upper[:-1]
        polynomials[1 : order + 2] += np.stack([g, -g]) * polynomials[order::-1]
        factor = 1 - g * g
        scale *= factor
        positive &= factor > 0
    return polynomials, scale, positive


def multipliers_from_moments(
    moments: Any, solve: Callable[[Any], tuple[Any, Mask]] = try_multipliers
) -> Any:
    """Multipliers (n, C) of the bounded maximum-entropy spectra with moments (n, C), by
    `try_multipliers` or its like.

    Near the boundary of the moment space the recursion breaks down. Such moments are
    blended with those of grey, with a weight of 1e−10 at first and at most 1e−4. Raises
    `UpliftError` for moments that no reflectance has.
    """
    multipliers, valid = blended_multipliers(moments, _GREY_WEIGHTS, solve)
    if valid.all():
        return multipliers
    raise UpliftError(
        "not the moments of any reflectance: "
        f"{pluralise((~valid).sum(), 'set')} of coefficients",
        code="invalid-moments",
    )


def blended_multipliers(
    moments: Any,
    weights: Sequence[float],
    solve: Callable[[Any], tuple[Any, Mask]] = try_multipliers,
) -> tuple[Any, Mask]:
    """Multipliers (n, C) of moments (n, C), and where (n,) they are valid. Those that
    are not are blended with grey, by one weight after another.
    """
    grey = np.zeros_like(moments[:1])
    grey[:, 0] = 0.5
    multipliers, valid = solve(moments)
    for weight in weights:
        pending = np.flatnonzero(~valid)
        if not pending.size:
            break
        blend = (1 - weight) * moments[pending] + weight * grey
        multipliers[pending], valid[pending] = solve(blend)
    return multipliers, valid
