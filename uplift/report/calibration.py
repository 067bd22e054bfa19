"""Comparison of a cube's standard errors with the errors of measurements that it was not built from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.expected_error import COVERAGE
from uplift.common.arrays import Array

TOLERANCE = 1.25
"""Largest factor, in both directions, between actual and predicted errors that counts as agreement."""


@dataclass(frozen=True)
class Calibration:
    """Actual errors of entries against predicted ones, ΔE00 under the cube's error illuminant."""

    count: int  # Number of entries
    actual: float  # Mean that they should have had, so that 68 % of the entries were within
    predicted: float  # Mean of the standard errors
    # Shares in [0, 1] of the entries whose error is at most its standard error, and its error bound
    within_error: float
    # Shares in [0, 1] of the entries whose error is at most its standard error, and its error bound
    within_bound: float

    @property
    def verdict(self) -> int:
        """Return 0 if both agree, 1 if the actual errors are larger, −1 if they are smaller."""
        if self.actual > TOLERANCE * self.predicted:
            return 1
        return -1 if self.predicted > TOLERANCE * self.actual else 0

    def to_json(self) -> dict[str, float]:
        """Return the numbers by their names in JSON output."""
        return {
            "count": self.count,
            "real": self.actual,
            "stated": self.predicted,
            "within_error": self.within_error,
            "within_bound": self.within_bound,
        }


def check_calibration(actual: Array, predicted: Array | None, bound: Array | None) -> Calibration | None:
    """Compare actual errors (n,) with standard errors and error bounds (n,); None if the cube has none."""
    if predicted is None or bound is None:
        return None
    mean, ratio = float(predicted.mean()), actual / np.maximum(predicted, np.finfo(float).tiny)
    return Calibration(
        count=len(actual),
        actual=mean * float(np.quantile(ratio, COVERAGE[0][0])),
        predicted=mean,
        within_error=float((actual <= predicted).mean()),
        within_bound=float((actual <= bound).mean()),
    )
