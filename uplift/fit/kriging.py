"""What an atlas says about colours between its entries: simple kriging of their deviation from smooth spectra.

docs/mathematics.md, 7: the deviation of an entry's multipliers from those of the smooth spectrum of its colour
correlates between colours as exp(−ΔE*ab / LENGTH). Far from all entries nothing is left of it.
Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25, 5.12 (leaving one out).
"""

from __future__ import annotations

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

from uplift.common.arrays import Array

LENGTH = 6.0
"""Distance in CIE L*a*b*, by cross-validation: docs/fidelity.md."""
NUGGET = 1e-3
"""Share of a deviation that is noise: entries of the same colour and another spectrum average."""
BLOCK = 1 << 20
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
        return _heard(lab, self.places, self.weights, self.length)[0]


def krige(places: Array, deviations: Array, length: float = LENGTH) -> tuple[Kriging, Array]:
    """The kriging of deviations (E, C) at L*a*b* (E, 3), and what it says of each entry without it (E, C)."""
    from scipy.linalg import cho_factor, cho_solve
    from scipy.linalg.lapack import dpotri

    factor = cho_factor(_kernel(places, places, length) + NUGGET * np.eye(len(places)))
    weights = cho_solve(factor, deviations)
    inverse, _ = dpotri(factor[0], overwrite_c=True)
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
        columns = np.stack([self.squares, np.ones(len(self.squares))], axis=1)
        sums, nearest = _heard(lab, self.places, columns)
        spread = (sums[:, 0] + PRIOR_COUNT * self.squares.mean()) / (sums[:, 1] + PRIOR_COUNT)
        return np.asarray(np.sqrt((1 - nearest**2) * spread + self.floor))


def uncertainty(places: Array, left_out: Array, kept: Array) -> Uncertainty:
    """Learn from ΔE00 (E,) of entries at L*a*b* (E, 3) left out, and of the same kept."""
    kernel = _kernel(places, places)
    np.fill_diagonal(kernel, 0)
    variance = np.maximum(1 - kernel.max(axis=1) ** 2, NEAREST)
    return Uncertainty(places, left_out**2 / variance, float((kept**2).mean()))


def _kernel(first: Array, second: Array, length: float = LENGTH) -> Array:
    from scipy.spatial.distance import cdist

    return np.exp(cdist(first, second) / -length)


def _heard(lab: Array, places: Array, columns: Array, length: float = LENGTH) -> tuple[Array, Array]:
    """At L*a*b* (n, 3): entries' columns (E, K) summed by their correlation, (n, K), and the largest of it (n,)."""
    rows = max(min(BLOCK // max(len(places), 1), len(lab)), 1)
    sums, nearest = np.empty((len(lab), columns.shape[1])), np.empty(len(lab))
    with jax.enable_x64(True):
        for first in range(0, len(lab), rows):
            part = slice(first, first + rows)
            block = np.resize(lab[part], (rows, 3))  # the last one filled up, so that one shape is compiled
            found = _heard_block(block, places, columns, length)
            count = len(lab[part])
            sums[part], nearest[part] = (np.asarray(array)[:count] for array in found)
    return sums, nearest


@jax.jit
def _heard_block(
    lab: jax.Array, places: jax.Array, columns: jax.Array, length: float
) -> tuple[jax.Array, jax.Array]:
    apart = ((lab[:, None] - places[None]) ** 2).sum(axis=-1)
    kernel = jnp.exp(jnp.sqrt(apart) / -length)
    return kernel @ columns, kernel.max(axis=1)
