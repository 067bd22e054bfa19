"""Do the standard errors of a cube hold? Judged by measurements that it has not seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.report.fidelity import Entries
from uplift.sensor import Array

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


def calibration(found: Entries) -> Calibration | None:
    """None where the cube states no errors."""
    if found.stated is None:
        return None
    return Calibration(
        count=len(found.names),
        real=_root_mean_square(found.real),
        stated=_root_mean_square(found.stated),
        within_one=float((found.real <= found.stated).mean()),
        within_two=float((found.real <= 2 * found.stated).mean()),
    )


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt((values**2).mean()))
