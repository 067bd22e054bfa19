"""Gaussian quadrature for weight functions given as samples, including functions that change sign.

The weight function is a discrete measure: points and their masses. For an evenly sampled function the masses are its
samples, multiplied by the step where the scale of the weights matters.

The common three-term recurrence fails where a lower order has no orthogonal polynomial. Here the measure is expanded
in polynomials that are orthonormal with respect to its absolute value (Stieltjes procedure), and the nodes are the
generalised eigenvalues of two such matrices. For masses of one sign this is the method of Golub & Welsch 1969,
"Calculation of Gauss quadrature rules", Mathematics of Computation 23.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError

__all__ = ["QuadratureRule", "gauss_rule", "interpolatory_rule"]

SINGULAR_TOLERANCE = 1e-11
"""Singular values below this fraction of the largest count as zero."""
NODE_TOLERANCE = 1e-7
"""Distances between nodes and imaginary parts below this fraction of half the range count as zero."""


@dataclass(frozen=True, eq=False)
class QuadratureRule:
    """``sum(weights * f(nodes))`` approximates ``sum(masses * f(points))``; nodes (n,) ascend within the points."""

    nodes: Array
    weights: Array

    def __len__(self) -> int:
        return len(self.nodes)


def gauss_rule(points: ArrayLike, masses: ArrayLike, order: int) -> QuadratureRule | str:
    """Compute the rule of ``order`` nodes that is exact for polynomials of degree below ``2 * order``.

    Points (N,) ascend. Masses (N,) of one sign have a rule of every order up to their number. Masses of both signs have
    no rule of an order without orthogonal polynomial, or whose nodes are complex, coincide, or lie outside the points:
    the reason is returned as text. Raises `OptionError`.

    >>> gauss_rule([-1, 0, 1], [1, 1, 1], 2).nodes.round(4)
    array([-0.8165,  0.8165])
    """
    points, masses = _checked(points, masses)
    used = masses != 0
    if not 1 <= order <= used.sum():
        hint = "an order needs as many masses that are not 0"
        raise OptionError(f"order must be in [1, {used.sum()}], got {order}", hint=hint)
    x, masses = _to_unit(points, points)[used], masses[used]
    basis = _orthonormal_basis(x, np.abs(masses), order)
    signed = basis * np.sign(masses)[:, None]
    gram = basis.T @ signed
    if np.linalg.svd(gram, compute_uv=False).min() <= SINGULAR_TOLERANCE:
        return "no polynomial of that order is orthogonal"
    return _solve(gram, basis.T @ (x[:, None] * signed), np.abs(masses).sum(), points)


def interpolatory_rule(nodes: ArrayLike, points: ArrayLike, masses: ArrayLike) -> QuadratureRule:
    """Compute the rule at distinct nodes (n,) that is exact for polynomials of degree below their number.

    The measure is that of `gauss_rule`. Raises `OptionError`.
    """
    points, masses = _checked(points, masses)
    nodes = np.sort(np.asarray(nodes, dtype=float))
    if np.any(np.diff(nodes) == 0):
        raise OptionError("nodes must be distinct", hint="give each node once")
    degree = len(nodes) - 1
    values = chebyshev.chebvander(_to_unit(nodes, points), degree)
    moments = masses @ chebyshev.chebvander(_to_unit(points, points), degree)
    return QuadratureRule(nodes, np.asarray(np.linalg.solve(values.T, moments), dtype=float))


def _solve(gram: Array, position: Array, total: float, points: Array) -> QuadratureRule | str:
    """Nodes and weights from the inner products of the basis, without and with a factor x, under the measure."""
    values, vectors = scipy.linalg.eig(position, gram)
    if np.abs(values.imag).max() > NODE_TOLERANCE:
        return "its nodes are not real"
    ascending = np.argsort(values.real)
    unit, vectors = values.real[ascending], vectors.real[:, ascending]
    if len(unit) > 1 and np.diff(unit).min() <= NODE_TOLERANCE:
        return "two of its nodes coincide"
    nodes = _from_unit(unit, points)
    outside = nodes[np.abs(unit) > 1 + NODE_TOLERANCE]
    if len(outside):
        return f"a node lies at {outside[0]:.1f}, outside {points[0]:g} to {points[-1]:g}"
    # An eigenvector vanishes at all nodes but its own; the first polynomial of the basis is the constant 1/√total.
    products = gram @ vectors
    return QuadratureRule(nodes, total * products[0] ** 2 / (vectors * products).sum(axis=0))


def _checked(points: ArrayLike, masses: ArrayLike) -> tuple[Array, Array]:
    points, masses = (np.array(values, dtype=float) for values in (points, masses))
    if points.ndim != 1 or points.shape != masses.shape or not np.all(np.diff(points) > 0):
        problem = f"points must ascend and have a mass each, got shapes {points.shape} and {masses.shape}"
        raise OptionError(problem, hint="sort the points")
    if not (np.isfinite(points).all() and np.isfinite(masses).all() and masses.any()):
        raise OptionError("points and masses must be finite, and not all masses 0", hint="remove NaN and infinity")
    return points, masses


def _orthonormal_basis(x: Array, masses: Array, count: int) -> Array:
    """Polynomials of degree 0, 1, … at x, times √masses: orthonormal columns (N, count).

    Each is orthogonalised twice against all lower ones, as the three-term recurrence loses orthogonality.
    """
    columns = np.sqrt(masses / masses.sum())[:, None]
    for _ in range(count - 1):
        column = x * columns[:, -1]
        for _ in range(2):
            column = column - columns @ (columns.T @ column)
        columns = np.column_stack([columns, column / np.linalg.norm(column)])
    return columns


def _to_unit(x: Array, points: Array) -> Array:
    """Map the range of the points to [−1, 1], which keeps powers well scaled."""
    return (2 * x - points[0] - points[-1]) / max(points[-1] - points[0], np.finfo(float).tiny)


def _from_unit(x: Array, points: Array) -> Array:
    return (points[0] + points[-1] + x * (points[-1] - points[0])) / 2
