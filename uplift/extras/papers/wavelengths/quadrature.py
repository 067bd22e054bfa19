"""Gaussian quadrature for weight functions given as samples, including functions that
change sign.

The weight function is a discrete measure: points and their masses. For an evenly
sampled function the masses are its samples, multiplied by the step where the scale of
the weights matters.

The common three-term recurrence fails where a lower order has no orthogonal polynomial.
Here the measure is expanded in polynomials that are orthonormal with respect to its
absolute value (Stieltjes procedure), and the nodes are the generalised eigenvalues of
two such matrices. For masses of one sign this is the method of Golub & Welsch 1969,
"Calculation of Gauss quadrature rules", Mathematics of Computation 23.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError

SINGULAR_TOLERANCE = 1e-11
"""Singular values below this fraction of the largest count as zero."""
NODE_TOLERANCE = 1e-7
"""Distances between nodes and imaginary parts below this fraction of half the range
count as zero.
"""


@dataclass(frozen=True, eq=False)
class QuadratureRule:
    """``sum(weights * f(nodes))`` approximates ``sum(masses * f(points))``; nodes (n,)
    ascend within the points.
    """

    nodes: Array
    weights: Array

    def __len__(self) -> int:
        return len(self.nodes)


def gauss_rule(points: ArrayLike, masses: ArrayLike, order: int) -> QuadratureRule:
    """Compute the rule of ``order`` nodes that is exact for polynomials of degree below
    ``2 * order``.

    Points (N,) ascend. Masses (N,) of one sign have a rule of every order up to their
    number. Masses of both signs have no rule of an order without orthogonal polynomial,
    or whose nodes are complex, coincide, or lie outside the points: raises
    `OptionError` (``undefined-rule``) with the reason.

    >>> gauss_rule([-1, 0, 1], [1, 1, 1], 2).nodes.round(4)
    array([-0.8165,  0.8165])
    """
    points = np.asarray(points, dtype=float)
    masses = np.asarray(masses, dtype=float)
    used = masses != 0
    x = _to_unit(points, points)[used]
    masses = masses[used]
    basis = _orthonormal_basis(x, np.abs(masses), order)
    # Inner products of the basis under the measure, without and with a factor x.
    signed = basis * np.sign(masses)[:, None]
    gram = basis.T @ signed
    position = basis.T @ (x[:, None] * signed)
    if np.linalg.svd(gram, compute_uv=False).min() <= SINGULAR_TOLERANCE:
        raise _undefined("no polynomial of that order is orthogonal")
    values, vectors = scipy.linalg.eig(position, gram)
    if np.abs(values.imag).max() > NODE_TOLERANCE:
        raise _undefined("its nodes are not real")
    ascending = np.argsort(values.real)
    unit = values.real[ascending]
    vectors = vectors.real[:, ascending]
    if len(unit) > 1 and np.diff(unit).min() <= NODE_TOLERANCE:
        raise _undefined("two of its nodes coincide")
    nodes = (points[0] + points[-1] + unit * (points[-1] - points[0])) / 2
    outside = nodes[np.abs(unit) > 1 + NODE_TOLERANCE]
    if len(outside):
        raise _undefined(
            f"a node lies at {outside[0]:.1f}, outside {points[0]:g} to {points[-1]:g}"
        )
    # An eigenvector vanishes at all nodes but its own; the first polynomial of the
    # basis is the constant 1/√Σ|masses|.
    products = gram @ vectors
    return QuadratureRule(
        nodes,
        np.abs(masses).sum() * products[0] ** 2 / (vectors * products).sum(axis=0),
    )


def interpolatory_rule(
    nodes: ArrayLike, points: Array, masses: Array
) -> QuadratureRule:
    """Compute the rule at distinct nodes (n,) that is exact for polynomials of degree
    below their number.
    """
    nodes = np.sort(np.asarray(nodes, dtype=float))
    degree = len(nodes) - 1
    values = chebyshev.chebvander(_to_unit(nodes, points), degree)
    moments = masses @ chebyshev.chebvander(_to_unit(points, points), degree)
    return QuadratureRule(
        nodes, np.asarray(np.linalg.solve(values.T, moments), dtype=float)
    )


def _undefined(reason: str) -> OptionError:
    return OptionError(reason, code="undefined-rule", hint="choose another order")


def _orthonormal_basis(x: Array, masses: Array, count: int) -> Array:
    """Polynomials of degree 0, 1, … at x, times √masses: orthonormal columns (N,
    count).

    Each is orthogonalised twice against all lower ones, as the three-term recurrence
    loses orthogonality.
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
    return (2 * x - points[0] - points[-1]) / max(
        points[-1] - points[0], np.finfo(float).tiny
    )
