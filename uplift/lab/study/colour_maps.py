"""Maps of XYZ under one light to XYZ under another: a matrix, and root polynomials.

A term of a root polynomial is the d-th root of a product of d of X, Y and Z. Terms
scale with the exposure, as colours do. Degrees 1, 2 and 3 have 3, 6 and 13 terms; the
first is a matrix. A map has no spectra, and it serves one light.

Finlayson, Mackiewicz & Hurlbert 2015, "Color correction using root-polynomial
regression", IEEE Transactions on Image Processing 24(5), section III.
"""

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from uplift.colorimetry import Light, delta_e_2000_weights, lab, lab_jacobian
from uplift.common.arrays import Array

DEGREES = {
    "3 × 3 matrix": 1,
    "root polynomial, 6 terms": 2,
    "root polynomial, 13 terms": 3,
}
"""Degree of a map by its name."""


@dataclass(frozen=True, eq=False)
class ColourMap:
    """Map of XYZ under a light to XYZ under another one, both relative to their whites.

    ``exponents`` (K, 3): those of X, Y and Z in each term. ``matrix`` (K, 3): weights
    of the terms.
    """

    exponents: Array
    matrix: Array

    def __call__(self, xyz: Array) -> Array:
        """Map XYZ (n, 3)."""
        return np.maximum(terms(xyz, self.exponents) @ self.matrix, 0)


def fit_map(degree: int, first: Light, second: Light, measured: Array) -> ColourMap:
    """Fit a map from one light to another to reflectances (E, N).

    It has the least squares of ΔE00, linear about the measured colours: on unseen
    materials this is better than least squares of XYZ.
    """
    exponents = term_exponents(degree)
    known = terms(measured @ first.xyz.T / first.white, exponents)
    goal = measured @ second.xyz.T / second.white
    white = np.ones(3)
    weights = delta_e_2000_weights(lab(goal, white)) @ lab_jacobian(goal, white)
    # A residual is weights · (matrixᵀ · terms − goal): a row for each of its parts.
    rows = np.einsum("nij,nk->nikj", weights, known).reshape(3 * len(known), -1)
    right = np.einsum("nij,nj->ni", weights, goal).ravel()
    solution = np.linalg.lstsq(rows, right)[0]
    return ColourMap(exponents, solution.reshape(-1, 3))


def term_exponents(degree: int) -> Array:
    """Exponents (K, 3) of X, Y and Z in the terms up to a degree, each once."""
    rows = []
    for order in range(1, degree + 1):
        for factors in combinations_with_replacement(range(3), order):
            rows.append(np.bincount(factors, minlength=3) / order)
    return np.unique(rows, axis=0)


def terms(xyz: Array, exponents: Array) -> Array:
    """Terms (n, K) of XYZ (n, 3)."""
    return np.prod(xyz[:, None] ** exponents, axis=2)
