"""Gaussian quadrature for weights given as samples, also such as change sign.

A weight is a discrete measure: points and their masses. For a function sampled evenly the masses are its
samples (times the step, where the scale of the rule's weights matters).

The usual recurrence breaks down where a lower order has no polynomial. So the weight is written in polynomials
that are orthonormal to its absolute value (Stieltjes' procedure), and the nodes are the generalised eigenvalues
of two such matrices; for masses of one sign that is the method of Golub & Welsch 1969, "Calculation of Gauss
quadrature rules".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from uplift.common.errors import OptionError

Array = NDArray[np.float64]

SINGULAR = 1e-11
"""Singular values up to this share of the largest are rounding."""
APART = 1e-7
"""Nodes this close, and imaginary parts this small, are rounding (as a share of half the points' range)."""


@dataclass(frozen=True, eq=False)
class QuadratureRule:
    """``Σ weights · f(nodes)`` stands for ``Σ masses · f(points)``.

    Parameters
    ----------
    nodes : (n,) ascending, within the points.
    weights : (n,) of either sign where the masses are.
    """

    nodes: Array
    weights: Array

    def __len__(self) -> int:
        return len(self.nodes)


@dataclass(frozen=True, eq=False)
class UndefinedRule:
    """An order that the weight has no rule of, and why.

    Parameters
    ----------
    order : the number of nodes asked for.
    reason : in words.
    """

    order: int
    reason: str


def gauss_rule(points: ArrayLike, masses: ArrayLike, order: int) -> QuadratureRule | UndefinedRule:
    """The rule of ``order`` nodes that is exact for every polynomial of degree below ``2 · order``.

    Masses of one sign have a rule of every order up to their number; masses of both signs lack those orders
    that have no orthogonal polynomial, or whose nodes are not real, coincide, or lie outside the points.

    Raises
    ------
    OptionError : points that do not ascend, masses of another number, an order out of range, or no masses.
    """
    points, masses = _checked(points, masses)
    used = masses != 0
    if not 1 <= order <= used.sum():
        raise OptionError(f"no rule of order {order}", hint=f"ask for 1 to {used.sum()}")
    x, masses = _to_unit(points, points)[used], masses[used]
    basis = _orthonormal(x, np.abs(masses), order)
    signed = basis * np.sign(masses)[:, None]
    gram = basis.T @ signed
    if np.linalg.svd(gram, compute_uv=False).min() <= SINGULAR:
        return UndefinedRule(order, "no polynomial of that order is orthogonal")
    return _solve(gram, basis.T @ (x[:, None] * signed), np.abs(masses).sum(), points)


def interpolatory_rule(nodes: ArrayLike, points: ArrayLike, masses: ArrayLike) -> QuadratureRule:
    """The rule at given ``nodes`` (n,) that is exact for every polynomial of degree below n.

    Raises
    ------
    OptionError : as `gauss_rule` does, or nodes that coincide.
    """
    points, masses = _checked(points, masses)
    nodes = np.sort(np.asarray(nodes, dtype=float))
    if np.any(np.diff(nodes) == 0):
        raise OptionError("two nodes coincide", hint="name each node once")
    degree = len(nodes) - 1
    values = chebyshev.chebvander(_to_unit(nodes, points), degree)
    moments = masses @ chebyshev.chebvander(_to_unit(points, points), degree)
    return QuadratureRule(nodes, np.asarray(np.linalg.solve(values.T, moments), dtype=float))


def _solve(gram: Array, position: Array, total: float, points: Array) -> QuadratureRule | UndefinedRule:
    """Nodes and weights from the weight's inner products of the basis, and those with x between."""
    values, vectors = scipy.linalg.eig(position, gram)
    order = len(gram)
    if np.abs(values.imag).max() > APART:
        return UndefinedRule(order, "its nodes are not real")
    ascending = np.argsort(values.real)
    unit, vectors = values.real[ascending], vectors.real[:, ascending]
    if order > 1 and np.diff(unit).min() <= APART:
        return UndefinedRule(order, "two of its nodes coincide")
    nodes = _from_unit(unit, points)
    outside = nodes[np.abs(unit) > 1 + APART]
    if len(outside):
        return UndefinedRule(
            order, f"a node lies at {outside[0]:.1f}, outside {points[0]:g} to {points[-1]:g}"
        )
    # A vector is 0 at all nodes but its own; the first polynomial of the basis is the constant 1/√total.
    seen = gram @ vectors
    return QuadratureRule(nodes, total * seen[0] ** 2 / (vectors * seen).sum(axis=0))


def _checked(points: ArrayLike, masses: ArrayLike) -> tuple[Array, Array]:
    points, masses = (np.array(values, dtype=float) for values in (points, masses))
    if points.ndim != 1 or points.shape != masses.shape or not np.all(np.diff(points) > 0):
        raise OptionError("points and masses do not match", hint="give ascending points and one mass each")
    if not (np.isfinite(points).all() and np.isfinite(masses).all() and masses.any()):
        raise OptionError("the masses are nothing, or not all numbers", hint="give finite masses, not all 0")
    return points, masses


def _orthonormal(x: Array, masses: Array, count: int) -> Array:
    """(N, count) the polynomials of degree 0, 1, … at x, times √masses: orthonormal columns.

    Each is made orthogonal to all before it, twice: the three-term recurrence alone forgets the early ones.
    """
    columns = np.sqrt(masses / masses.sum())[:, None]
    for _ in range(count - 1):
        new = x * columns[:, -1]
        for _ in range(2):
            new = new - columns @ (columns.T @ new)
        columns = np.column_stack([columns, new / np.linalg.norm(new)])
    return columns


def _to_unit(x: Array, points: Array) -> Array:
    """The points' range on [−1, 1], where powers stay tame."""
    return (2 * x - points[0] - points[-1]) / max(points[-1] - points[0], np.finfo(float).tiny)


def _from_unit(x: Array, points: Array) -> Array:
    return (points[0] + points[-1] + x * (points[-1] - points[0])) / 2
