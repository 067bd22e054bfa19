"""Phosphor curves as spectra (Fishkin 1983, chapter 7).

The curve of a colour is the sum of the monitor's phosphor spectra that display it (eq. 7.1). Curves are treated as
transmittances and multiplied as filters (eq. 9.1). The result is the monitor RGB that matches the product.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.common.arrays import Array
from uplift.design.mixing import filters


@dataclass(frozen=True, eq=False)
class Monitor:
    """A display with three primaries.

    Parameters
    ----------
    curves : ndarray of shape (3, N)
        Spectra of red, green and blue at full drive.
    to_rgb : ndarray of shape (3, N)
        Matrix from a curve to its RGB.
    """

    curves: Array
    to_rgb: Array

    def mix(self, rgb: ArrayLike, thickness: ArrayLike) -> Array:
        """Mix colours as filters.

        Parameters
        ----------
        rgb : array_like of shape (..., n, 3)
            Linear RGB of the filters.
        thickness : array_like of shape (..., n)
            Their thickness.

        Returns
        -------
        ndarray of shape (..., 3)
            Linear RGB, at least 0.
        """
        curves = np.asarray(rgb, dtype=float) @ self.curves
        return np.maximum(filters.stack(curves, thickness) @ self.to_rgb.T, 0)


def make_monitor(primaries: str = observer.CRT, white: str = DEFAULT_ILLUMINANT) -> Monitor:
    """Make a monitor of named primaries.

    The curve of white is scaled to a maximum of 1 (Fishkin 1983, section 7.2), so that no curve amplifies light.

    Parameters
    ----------
    primaries : str
        Name of a display in colour-science.
    white : str
        Name of the illuminant that full drive matches.

    Returns
    -------
    Monitor
        The monitor.

    Raises
    ------
    UnknownNameError
        A name is unknown.
    """
    phosphors = observer.display_primaries(primaries).T
    matching = observer.matching_functions()
    curves = phosphors * np.linalg.solve((phosphors @ matching).T, observer.light(white).white)[:, None]
    curves /= curves.sum(axis=0).max()
    return Monitor(curves, np.asarray(np.linalg.solve((curves @ matching).T, matching.T), dtype=float))
