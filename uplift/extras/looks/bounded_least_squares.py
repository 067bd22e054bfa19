"""Linear least squares within bounds: spectra for given colours. The problem is convex,
so the minimum is global.

Palettes are solved by it (Bergner, Möller & Drew 2004, section 3.3), and the
reflectances of looks.
"""

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning, warn
from uplift.common.machine import single_threaded_blas

TOLERANCE = 1e-12
"""Relative change at which the solver stops."""
MAX_ITERATIONS = 1000


def solve_bounded(matrix: Array, values: Array, low: Array, high: Array) -> Array:
    """Minimise ‖M x − y‖ for a matrix (rows, n) and values (rows,) within bounds (n,)
    of x, some of them finite.

    By an active-set method, BVLS of Stark & Parker 1995 in scipy's ``lsq_linear``.
    `UpliftWarning` (``design-not-converged``) if it stops early.
    """
    from scipy.optimize import lsq_linear

    with single_threaded_blas():  # also of scipy, as it is loaded
        result = lsq_linear(
            matrix,
            values,
            (low, high),
            method="bvls",
            tol=TOLERANCE,
            max_iter=MAX_ITERATIONS,
        )
    if not result.success:
        text = (
            f"the solver stopped after {MAX_ITERATIONS} iterations: colours may be "
            "slightly off"
        )
        warn(UpliftWarning(text, code="design-not-converged"))
    return np.clip(result.x, low, high)  # removes rounding errors
