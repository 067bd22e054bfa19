"""Comparison of a cube's standard errors with the errors of measurements that it was not built from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array

TOLERANCE = 1.25
"""Largest factor, in both directions, between actual and predicted errors that counts as agreement."""


@dataclass(frozen=True)
class Calibration:
    """Actual errors of entries against predicted ones, ΔE00 under the cube's error illuminant.

    Parameters
    ----------
    count : int
        Number of entries.
    actual, predicted : float
        Root mean squares of the errors and of the standard errors.
    within_one, within_two : float
        Shares in [0, 1] of the entries whose error is at most one and two of its standard errors.
    """

    count: int
    actual: float
    predicted: float
    within_one: float
    within_two: float

    @property
    def verdict(self) -> int:
        """Return 0 if both agree, 1 if the actual errors are larger, −1 if they are smaller."""
        if self.actual > TOLERANCE * self.predicted:
            return 1
        return -1 if self.predicted > TOLERANCE * self.actual else 0

    def to_json(self) -> dict[str, float]:
        """Return the numbers by their names in JSON output.

        Returns
        -------
        dict
            ``real`` and ``stated`` are ``actual`` and ``predicted``.
        """
        return {
            "count": self.count,
            "real": self.actual,
            "stated": self.predicted,
            "within_one": self.within_one,
            "within_two": self.within_two,
        }


def check_calibration(actual: Array, predicted: Array | None) -> Calibration | None:
    """Compare errors with standard errors.

    Parameters
    ----------
    actual : ndarray, shape (n,)
        Errors, ΔE00.
    predicted : ndarray, shape (n,), or None
        Standard errors, ΔE00; None if the cube has none.

    Returns
    -------
    Calibration or None
        None without standard errors.

    Examples
    --------
    >>> check_calibration(np.array([1.0, 3.0]), np.array([2.0, 2.0]))
    Calibration(count=2, actual=2.23606797749979, predicted=2.0, within_one=0.5, within_two=1.0)
    """
    if predicted is None:
        return None
    return Calibration(
        count=len(actual),
        actual=_rms(actual),
        predicted=_rms(predicted),
        within_one=float((actual <= predicted).mean()),
        within_two=float((actual <= 2 * predicted).mean()),
    )


def _rms(values: Array) -> float:
    return float(np.sqrt((values**2).mean()))
