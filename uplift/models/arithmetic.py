"""Arithmetic that dominates the cost of fits and lookups: the arc tangent, and products
of tall and small matrices.

The arc tangent of XLA calls the scalar function of the C library. A polynomial
vectorises: it is several times faster and as accurate
(tests/models/test_arithmetic.py). numpy passes through memory for every term, so there
the polynomial gains nothing, but a series for small differences of arc tangents does.

The BLAS of numpy distributes products of tall and small matrices over threads, which
costs more than it saves, most of all where other processes use the cores. Slices below
its threshold stay on one thread.
"""

from typing import Any

import numpy as np

from uplift.common.arrays import Array

SINGLE_THREAD_SIZE = 1 << 17
"""Multiplications per slice; OpenBLAS starts threads at twice as many."""
# arctan(√u) / √u on [0, 1], interpolated at 20 Chebyshev nodes in 60 digits; to 3e-16
# of the value.
_POLYNOMIAL = (
    1.0,
    -0.333333333333307,
    0.1999999999964796,
    -0.14285714266926733,
    0.11111110578002083,
    -0.09090899793217341,
    0.07692198997458294,
    -0.06665764910689723,
    0.058768281144872724,
    -0.052374234719188166,
    0.04668745304848529,
    -0.040811247503178855,
    0.03387126702700675,
    -0.02556862364437174,
    0.01671959606350739,
    -0.00899108054265826,
    0.003751138483965141,
    -0.0011252544302234645,
    0.00021423810738603946,
    -1.93423475928923e-05,
)

NEAR = 1 / 32
"""Up to this argument, three terms of the Taylor series have a relative error below
2e-10.
"""


def arctan(x: Any) -> Any:
    """Arc tangent of a numpy or JAX array; differentiable in JAX."""
    xp = x.__array_namespace__()
    if xp is np:
        return np.arctan(x)
    # If |x| > 1, arctan x = ±π/2 + arctan(−1/x)
    large = xp.abs(x) > 1
    t = xp.where(large, -1 / xp.where(large, x, 1), x)
    u = t * t
    series = _POLYNOMIAL[-1]
    for coefficient in _POLYNOMIAL[-2::-1]:
        series = series * u + coefficient
    return t * series + xp.where(large, xp.copysign(np.pi / 2 * xp.ones_like(x), x), 0)


def arctan_difference(x: Array, change: Array) -> Array:
    """Evaluate arctan(x + change) − arctan(x) of numpy arrays (N, n) to 1e-9 of the
    largest difference of a column.

    The difference is the arc tangent of change / (1 + x (x + change)), whose argument
    is usually small. Columns with a large argument, or with a difference of more than
    π/2, are computed from both arc tangents.
    """
    with np.errstate(all="ignore"):  # NaN counts as far
        denominator = x + change
        denominator *= x
        denominator += 1
        far = denominator.min(axis=0) <= 0
        z = np.divide(change, denominator, out=denominator)
        square = z * z
        far |= ~(square.max(axis=0) <= NEAR * NEAR)
        difference = square / 5
        difference -= 1 / 3
        difference *= square
        difference *= z
        difference += z
    if far.any():
        difference[:, far] = np.arctan(x[:, far] + change[:, far]) - np.arctan(
            x[:, far]
        )
    return difference


def blocked_matmul(rows: Any, matrix: Any) -> Any:
    """Compute ``rows`` (n, K) @ ``matrix`` (K, N) of numpy or JAX arrays."""
    if rows.__array_namespace__() is not np:
        return rows @ matrix
    product = np.empty((len(rows), matrix.shape[1]))
    size = max(SINGLE_THREAD_SIZE // matrix.size, 1)
    full = len(rows) // size * size
    np.matmul(
        rows[:full].reshape(-1, size, rows.shape[1]),
        matrix,
        out=product[:full].reshape(-1, size, matrix.shape[1]),
    )
    np.matmul(rows[full:], matrix, out=product[full:])
    return product


def blocked_matmul_columns(matrix: Array, columns: Array) -> Array:
    """Compute ``matrix`` (M, K) @ ``columns`` (K, n) of numpy arrays."""
    product = np.empty((len(matrix), columns.shape[1]))
    size = max(SINGLE_THREAD_SIZE // matrix.size, 1)
    full = columns.shape[1] // size * size
    slices, targets = (
        array[:, :full].reshape(len(array), -1, size).swapaxes(0, 1)
        for array in (columns, product)
    )
    np.matmul(matrix, slices, out=targets)
    np.matmul(matrix, columns[:, full:], out=product[:, full:])
    return product
