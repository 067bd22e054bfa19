"""The thesis's spectra (chapter 7): a colour's curve is the sum of the monitor's phosphors that show it (7.1).

Taken for transmittances they are multiplied as filters (9.1), and the monitor's RGB that matches what is left is
the answer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.design.mixing import filters


@dataclass(frozen=True, eq=False)
class Monitor:
    """``curves`` (3, N) of red, green and blue at full drive; ``back`` (3, N) takes a curve to its RGB."""

    curves: Array
    back: Array

    def filtered(self, rgb: ArrayLike, thickness: ArrayLike) -> Array:
        """RGB (…, 3), not below 0, of filters of RGB (…, n, 3), ``thickness`` (…, n) each."""
        curves = np.asarray(rgb, dtype=float) @ self.curves
        return np.maximum(filters.stacked(curves, thickness) @ self.back.T, 0)


def monitor(primaries: str = observer.CRT, white: str = "D65") -> Monitor:
    """A monitor by the name of its primaries, set to a white; its white's curve ends at 1 where it is highest.

    That is the scaling that 7.2 asks for: none of the curves is above 1, so that none makes light. Raises
    `UnknownNameError`.
    """
    phosphors = observer.display_primaries(primaries).T
    matching = observer.matching_functions()
    curves = phosphors * np.linalg.solve((phosphors @ matching).T, observer.light(white).white)[:, None]
    curves /= curves.sum(axis=0).max()
    return Monitor(curves, np.asarray(np.linalg.solve((curves @ matching).T, matching.T), dtype=float))
