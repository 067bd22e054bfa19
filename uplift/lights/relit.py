"""Colours of surfaces under a lamp and under an estimate of it."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab_of
from uplift.common.arrays import Array


def relit_delta_e(lamps: Array, estimates: Array, reflectances: Array, radiometry: Array) -> Array:
    """Compare surfaces lit by lamps with the same surfaces lit by estimates, each adapted to its own white.

    Parameters
    ----------
    lamps, estimates : ndarray, shape (L, N)
        Power, of any scale.
    reflectances : ndarray, shape (P, N)
        Reflectances of the surfaces.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.

    Returns
    -------
    ndarray, shape (L, P)
        ΔE00 between CIE L*a*b* of the perfect reflector's white under the respective light.
    """
    first, second = (_relit_lab(power, reflectances, radiometry) for power in (lamps, estimates))
    return delta_e_2000(first, second)


def _relit_lab(power: Array, reflectances: Array, radiometry: Array) -> Array:
    """CIE L*a*b* (L, P, 3).

    For the 10° observer sodium light has no Z. Z relative to white is then the ratio of luminances, as it is for all
    single wavelengths.
    """
    weights = (reflectances[:, :, None] * radiometry).transpose(1, 0, 2).reshape(len(radiometry), -1)
    xyz = (power @ weights).reshape(len(power), -1, 3)
    white = (power @ radiometry)[:, None]
    missing = white <= 0
    return np.asarray(lab_of(np.where(missing, xyz[..., 1:2], xyz), np.where(missing, white[..., 1:2], white)))
