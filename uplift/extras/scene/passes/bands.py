"""Bands of wavelengths, three per pass of an RGB renderer: their averages of spectra.

A band k has the weights w_k(λ) of a Gaussian, whose sum is 1. The texture of the band
is Σ w_k ρ, which lies in [0, 1] as the reflectance ρ does.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

CHANNELS = 3
"""Bands of a pass: red, green and blue of the renderer."""
MAX_PASSES = 4
FINE_STEP = 1.0
"""Step in nm in which Gaussians are summed."""
MAX_WIDTH = 60.0
"""Largest standard deviation of a band in nm."""


@dataclass(frozen=True)
class Bands:
    """Gaussian bands of one width.

    Parameters
    ----------
    centres : tuple of float
        K ascending wavelengths in nm, within 380 to 780; K is a multiple of 3.
    width : float
        Standard deviation in nm, 0 to 60. Bands of width 0 are points: they take the
        reflectance at their centre, linear between samples of 5 nm.

    Raises
    ------
    OptionError
        The centres or the width are not as described.
    """

    centres: tuple[float, ...]
    width: float

    def __post_init__(self) -> None:
        largest = CHANNELS * MAX_PASSES
        count = len(self.centres)
        if not 0 < count <= largest or count % CHANNELS:
            raise OptionError(
                f"bands must be 3, 6, 9 or 12, got {count}",
                hint="a pass of an RGB renderer has three",
            )
        at = np.array(self.centres, dtype=float)
        inside = (at >= observer.START) & (at <= observer.END)
        if not inside.all() or (np.diff(at) <= 0).any():
            raise OptionError(
                f"centres must ascend within [{observer.START:g}, {observer.END:g}] nm",
                hint="sort them, and remove duplicates",
            )
        if not 0 <= self.width <= MAX_WIDTH:
            raise OptionError(
                f"width must be in [0, {MAX_WIDTH:g}] nm, got {self.width:g}"
            )

    def __len__(self) -> int:
        return len(self.centres)

    @property
    def passes(self) -> int:
        """Number of passes."""
        return len(self) // CHANNELS

    @cached_property
    def weights(self) -> Array:
        """Weights (K, 81): ``reflectance @ weights.T`` are the numbers of a surface.

        They are for samples at 380, 385, …, 780 nm, between which a reflectance is
        linear.
        """
        centres = np.array(self.centres, dtype=float)
        table = observer.grid()
        if self.width == 0:
            hats = [np.interp(centres, table, row) for row in np.eye(len(table))]
            return np.stack(hats, axis=1)
        distance = (_fine_grid() - centres[:, None]) / self.width
        gaussian = np.exp(-(distance**2) / 2)
        gaussian /= gaussian.sum(axis=1, keepdims=True)
        return gaussian @ _hat_functions().T


def _fine_grid() -> Array:
    """Wavelengths (401,) in nm."""
    return np.arange(observer.START, observer.END + FINE_STEP / 2, FINE_STEP)


@cache
def _hat_functions() -> Array:
    """Basis (81, 401) of linear interpolation between the samples of spectra."""
    table = observer.grid()
    return np.stack([np.interp(_fine_grid(), table, row) for row in np.eye(len(table))])


PRESETS = {
    1: Bands((451.0, 543.0, 600.0), 19.0),
    2: Bands((449.0, 499.0, 543.0, 580.0, 610.0, 652.0), 10.0),
    3: Bands((432.0, 458.0, 489.0, 517.0, 545.0, 570.0, 593.0, 620.0, 662.0), 4.0),
    4: Bands(
        (
            *(429.0, 452.0, 476.0, 500.0, 522.0, 544.0),
            *(562.0, 580.0, 598.0, 616.0, 644.0, 687.0),
        ),
        2.0,
    ),
}
"""Bands by the number of passes, chosen for the library of materials under six lights,
for those who do not search: docs/guides/passes.md.
"""
