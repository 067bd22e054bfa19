"""How much of an atlas entry the corners of its cell start from, by their distance from it in colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array

NEAR, FAR = 8.0, 16.0
"""ΔE*ab up to which a corner is near its entry, and from which it is far (docs/fidelity.md)."""


@dataclass(frozen=True)
class CornerShare:
    """Share of an entry in the start of the corners of its cell; the rest is the prior.

    Parameters
    ----------
    near : float
        Share, 0 to 1, at corners up to `NEAR` ΔE*ab from the entry.
    far : float, default 0
        Share, 0 to 1, at corners from `FAR` ΔE*ab. It changes linearly between them.
    """

    near: float
    far: float = 0.0

    def __call__(self, distance: Array) -> Array:
        """Share (n,) at ΔE*ab (n,) from the entry."""
        return np.interp(distance, (NEAR, FAR), (self.near, self.far))


ENTRY_ALONE = CornerShare(near=1.0, far=1.0)
"""Tódová 2020, section 3.1.2."""
