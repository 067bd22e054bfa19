"""Maps of XYZ under one light to XYZ under another: a matrix, and root polynomials.

A term of a root polynomial is the d-th root of a product of d of X, Y and Z. Terms
scale with the exposure, as colours do. Degrees 1, 2 and 3 have 3, 6 and 13 terms; the
first is a matrix. A map has no spectra, and it serves one light.

Finlayson, Mackiewicz & Hurlbert 2015, "Color correction using root-polynomial
regression", IEEE Transactions on Image Processing 24(5), section III.
"""

from collections.abc import Callable
from functools import partial
from itertools import combinations_with_replacement

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000_weights, lab, lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.lab.method import PreparedMap
from uplift.lab.runner import Prepare, Task


def fit_map(
    degree: int, first: Light, second: Light, measured: Array
) -> Callable[[Array], Array]:
    """Fit a map of XYZ (n, 3) from one light to another to reflectances (E, N), both
    relative to their whites.

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
    matrix = np.linalg.lstsq(rows, right)[0].reshape(-1, 3)
    return lambda xyz: np.maximum(terms(xyz, exponents) @ matrix, 0)


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


def prepare(task: Task, degree: int) -> PreparedMap:
    """Fit a map to the library, for each light that is queried for."""
    build = task.sensor.light

    def colours(rgb: Array, light: Light) -> Array:
        to_light = fit_map(degree, build, light, task.library)
        return to_light(task.sensor.xyz(rgb) / build.white)

    return PreparedMap(colours)


MAPS: dict[str, Prepare] = {
    "3 × 3 matrix": partial(prepare, degree=1),
    "root polynomial, 6 terms": partial(prepare, degree=2),
    "root polynomial, 13 terms": partial(prepare, degree=3),
}
"""Maps by their names."""
