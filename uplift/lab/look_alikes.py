"""Families of the library that are too close to spectra to be tested with them."""

import numpy as np
from scipy.spatial import KDTree

from uplift.common.arrays import Array
from uplift.fit.families import shipped_library

SAME_RMS = 1e-3
"""rms difference within which spectra are the same measurement."""
LOOK_ALIKE = 0.02
"""rms difference within which spectra look alike."""
MANY = 0.25
"""Share of a set from which its look-alikes count: two in five patches of ColorCheckers
have one in rawtoaces, and other sets in other families under a quarter.
"""


def families_like(measured: Array) -> tuple[str, ...]:
    """Names of the shipped families that contain one of some spectra (n, 81), or
    look-alikes of many of them.
    """
    if not len(measured):
        return ()
    names = []
    for family in shipped_library():
        distance = KDTree(family.measured).query(measured)[0]
        rms = distance / np.sqrt(measured.shape[1])
        if rms.min() <= SAME_RMS or (rms <= LOOK_ALIKE).mean() >= MANY:
            names.append(family.name)
    return tuple(names)
