"""Colours of increasing values: one hue, pale to dark. Orange is reserved for failures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array

RAMP = ("#eef5f8", "#a9cfe3", "#5a9fcb", "#20609a", "#0b1d51")


def colour_map() -> Any:
    """Return the ramp as a colour map of matplotlib.

    Returns
    -------
    matplotlib.colors.LinearSegmentedColormap
    """
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("ramp", RAMP)


def ramp_codes(values: Array | Sequence[float]) -> NDArray[np.uint8]:
    """Return 8-bit sRGB codes of values.

    Parameters
    ----------
    values : ndarray or sequence of float
        Values from 0, pale, to 1, dark; values outside are clipped.

    Returns
    -------
    ndarray of uint8, shape (..., 3)

    Examples
    --------
    >>> ramp_codes([0.0, 1.0]).tolist()
    [[238, 245, 248], [11, 29, 81]]
    """
    anchors = np.array([list(bytes.fromhex(code[1:])) for code in RAMP], dtype=float)
    positions = np.linspace(0, 1, len(RAMP))
    channels = [np.interp(values, positions, column) for column in anchors.T]
    return np.rint(np.stack(channels, axis=-1)).astype(np.uint8)
