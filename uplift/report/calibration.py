"""Do the standard errors of a cube hold? Judged by measurements that it has not seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array

ABOUT_RIGHT = 1.25
"""Factor, either way, within which nobody should make anything of a difference of real and stated errors."""


@dataclass(frozen=True)
class Calibration:
    """Real errors of ``count`` entries against stated ones, ΔE00 under the cube's reference light.

    ``real`` and ``stated`` are root mean squares; ``within_one`` and ``within_two`` the shares, 0 to 1, of entries
    whose error is at most one and two of its standard errors.
    """

    count: int
    real: float
    stated: float
    within_one: float
    within_two: float

    @property
    def verdict(self) -> int:
        """0 where both agree, 1 where the cube missed by more than it had stated, −1 where by less."""
        if self.real > ABOUT_RIGHT * self.stated:
            return 1
        return -1 if self.stated > ABOUT_RIGHT * self.real else 0


def calibration(real: Array, stated: Array | None) -> Calibration | None:
    """Of real and stated errors (n,), ΔE00. None where the cube states none."""
    if stated is None:
        return None
    return Calibration(
        count=len(real),
        real=_root_mean_square(real),
        stated=_root_mean_square(stated),
        within_one=float((real <= stated).mean()),
        within_two=float((real <= 2 * stated).mean()),
    )


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt((values**2).mean()))
