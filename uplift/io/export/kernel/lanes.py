"""Conversion of moments to multipliers for several colours side by side, in the lanes of a vector register."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import COUNT, LANES, Coefficients, Lane, Lanes, empty, unroll
    from uplift.io.export.kernel.moments import dual


def duals(moments: Lanes, multipliers: Lanes, valid: Lane) -> None:
    """Compute multipliers of moments, order by order; ``valid`` is 0 where Schur's algorithm breaks down."""
    for lane in range(LANES):
        given: Coefficients = empty(COUNT)
        found: Coefficients = empty(COUNT)
        for k in unroll(0, COUNT):
            given[k] = moments[k * LANES + lane]
        valid[lane] = 1.0 if dual(given, found) else 0.0
        for k in unroll(0, COUNT):
            multipliers[k * LANES + lane] = found[k]
