"""Digests of the powers of lights, which do not depend on rounding."""

import hashlib

import numpy as np

from uplift.common.arrays import Array

STEPS = 1_000_000
"""Steps of power up to the largest."""


def power_digest(power: Array) -> str:
    """SHA-256 of a power (81,) relative to its largest value.

    >>> power_digest(np.array([1.0, 2.0])) == power_digest(np.array([2.0, 4.0]))
    True
    """
    relative = np.rint(STEPS * power / power.max()).astype("<u4")
    return hashlib.sha256(relative.tobytes()).hexdigest()
