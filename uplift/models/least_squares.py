"""Levenberg and Marquardt's method for many small problems at a time, in numpy: nothing
is compiled, and problems that are solved leave their block.

Nielsen's damping: Madsen, Nielsen & Tingleff 2004, "Methods for non-linear least
squares problems", section 3.2. A JAX program pays for thousands of problems
(`uplift.fit.solver`); atlas entries and paints are fewer.
"""

from collections.abc import Callable

import numpy as np

from uplift.common.arrays import Array, Indices, blocks

ROWS = 128
"""Problems of a block."""
PRECISION = 1e-8
"""Relative reduction of the squares, and relative change of the variables, at which a
problem is solved.
"""
FIRST_DAMPING = 1e-3
"""Initial μ relative to the largest diagonal element of JᵀJ."""

Residuals = Callable[[Array, Indices], Array]
"""From variables (k, C) of the problems ``rows`` (k,) to residuals f (k, m)."""
NormalEquations = Callable[[Array, Array, Indices], tuple[Array, Array]]
"""From variables, their residuals and ``rows`` to JᵀJ (k, C, C) and Jᵀf (k, C), with
J = ∂f/∂y.
"""


def least_squares(
    residuals: Residuals,
    normal_equations: NormalEquations,
    start: Array,
    *,
    max_steps: int,
    precision: float = PRECISION,
    limit: float = np.inf,
) -> Array:
    """Minimise the sum of squares of the residuals of each row, from ``start`` (n, C).

    No sum of squares increases. A row does not depend on the others. Steps are clipped
    to ±``limit``: where squares fall for ever, variables stay finite; a minimum on the
    limit is not one of bounded least squares.
    """
    y = start.copy()
    for block in blocks(len(y), ROWS):
        rows = np.arange(block.start, block.stop)
        values = residuals(y[rows], rows)
        damping = np.zeros(len(rows))
        growth = np.full(len(rows), 2.0)  # of μ after the next rejected step
        for _ in range(max_steps):
            now = y[rows]
            gram, slope = normal_equations(now, values, rows)
            largest = gram.diagonal(axis1=-2, axis2=-1).max(axis=-1)
            damping = np.where(damping > 0, damping, FIRST_DAMPING * largest)
            # (JᵀJ + μ I) Δy = −Jᵀ f
            damped = gram + damping[:, None, None] * np.eye(y.shape[1])
            change = -np.linalg.solve(damped, slope[..., None])[..., 0]
            trial = np.clip(now + change, -limit, limit)
            left = residuals(trial, rows)
            before = (values**2).sum(axis=-1)
            after = (left**2).sum(axis=-1)
            # ϱ: the reduction of the squares over that of the linear model
            expected = (change * (damping[:, None] * change - slope)).sum(axis=-1)
            gain = (before - after) / np.maximum(expected, np.finfo(float).tiny)
            better = gain > 0
            y[rows] = np.where(better[:, None], trial, now)
            values = np.where(better[:, None], left, values)
            # max(1/3, 1 − (2ϱ − 1)³) after an accepted step
            shrinkage = np.maximum(1 / 3, 1 - (2 * gain - 1) ** 3)
            damping = damping * np.where(better, shrinkage, growth)
            growth = np.where(better, 2.0, 2 * growth)
            size = np.linalg.norm(now, axis=-1)
            is_small = np.linalg.norm(change, axis=-1) <= precision * size
            least = precision * before
            is_flat = better & (before - after <= least) & (expected <= least)
            kept = ~(is_small | is_flat)
            rows, values, damping, growth = (
                array[kept] for array in (rows, values, damping, growth)
            )
            if not rows.size:
                break
    return y
