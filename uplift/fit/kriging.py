"""What an atlas says about colours between its entries: simple kriging of their deviation from smooth spectra.

docs/mathematics.md, 7: the deviation of an entry's multipliers from those of the smooth spectrum of its colour
correlates between colours as exp(−ΔE*ab / LENGTH). Far from all entries nothing is left of it.
Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25, 5.12 (leaving one out).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.sensor import Array

LENGTH = 6.0
"""Distance in CIE L*a*b*, by cross-validation: docs/fidelity.md."""
NUGGET = 1e-3
"""Share of a deviation that is noise: entries of the same colour and another spectrum average."""
BLOCK = 1 << 22
"""Numbers of the kernel held at a time."""
PRIOR_COUNT = 2.0
"""How many entries' worth the mean error of all counts where a colour has its own neighbours."""
NEAREST = 0.02
"""The least variance that an entry left out is taken to have."""


@dataclass(frozen=True, eq=False)
class Kriging:
    """``places`` (E, 3) L*a*b* of the entries, ``weights`` (E, C) of the kernel of ``length`` around each."""

    places: Array
    weights: Array
    length: float = LENGTH

    def __call__(self, lab: Array) -> Array:
        """Deviation of the multipliers (n, C) at L*a*b* (n, 3)."""
        return _blockwise(self._block, lab, len(self.places))

    def _block(self, lab: Array) -> Array:
        return _kernel(lab, self.places, self.length) @ self.weights


def krige(places: Array, deviations: Array, length: float = LENGTH) -> tuple[Kriging, Array]:
    """The kriging of deviations (E, C) at L*a*b* (E, 3), and what it says of each entry without it (E, C)."""
    from scipy.linalg import cho_factor, cho_solve

    count = len(places)
    factor = cho_factor(_kernel(places, places, length) + NUGGET * np.eye(count))
    weights = cho_solve(factor, deviations)
    inverse = cho_solve(factor, np.eye(count))
    return Kriging(places, weights, length), deviations - weights / np.diag(inverse)[:, None]


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """How far answers are from measurements, learnt from entries left out.

    ``places`` (E, 3) L*a*b*; ``squares`` (E,) ΔE00² of each entry when left out, per unit of variance;
    ``floor`` ΔE00² that remains at the entries themselves.
    """

    places: Array
    squares: Array
    floor: float

    def __call__(self, lab: Array) -> Array:
        """Standard error (n,), ΔE00, at L*a*b* (n, 3)."""
        return _blockwise(self._block, lab, len(self.places))

    def _block(self, lab: Array) -> Array:
        kernel = _kernel(lab, self.places)
        local = kernel @ self.squares + PRIOR_COUNT * self.squares.mean()
        spread = local / (kernel.sum(axis=1) + PRIOR_COUNT)
        return np.sqrt((1 - kernel.max(axis=1) ** 2) * spread + self.floor)


def uncertainty(places: Array, left_out: Array, kept: Array) -> Uncertainty:
    """Learn from ΔE00 (E,) of entries at L*a*b* (E, 3) left out, and of the same kept."""
    kernel = _kernel(places, places)
    np.fill_diagonal(kernel, 0)
    variance = np.maximum(1 - kernel.max(axis=1) ** 2, NEAREST)
    return Uncertainty(places, left_out**2 / variance, float((kept**2).mean()))


def _kernel(first: Array, second: Array, length: float = LENGTH) -> Array:
    from scipy.spatial.distance import cdist

    return np.exp(cdist(first, second) / -length)


def _blockwise(function: Callable[[Array], Array], lab: Array, count: int) -> Array:
    size = max(BLOCK // max(count, 1), 1)
    return np.concatenate([function(lab[i : i + size]) for i in range(0, len(lab), size)])
