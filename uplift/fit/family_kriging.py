"""Kriging of families of materials: a deviation that all materials share, and one of each family.

The deviation of a material of family f at the colour x is d(x) + d_f(x) + noise. d and d_f are independent Gaussian
processes over CIE L*a*b* with the same Matérn correlation; their variances are 1 and the spread of the family. What is
expected of a material of no known family is E[d(x)], so a large family does not outweigh several small ones.

References
----------
Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25 and 4.17 (ν = 3/2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices

LENGTH = 20.0
"""Correlation length in CIE L*a*b*: docs/prior.md."""
NUGGET = 0.3
"""Variance of the noise of a material, relative to that of the shared deviation."""
BLOCK_NUMBERS = 1 << 17
"""Numbers of the kernel matrix held at a time."""
MAX_POINTS = 1200
"""Points of a family. More spectra are averaged in cubes of L*a*b*."""
CELLS = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
"""Edges of these cubes in L*a*b*; the smallest that suffices is taken."""


@dataclass(frozen=True, eq=False)
class FamilySamples:
    """Deviations of the spectra of a family.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b*.
    deviations : ndarray, shape (E, N)
        Deviations.
    counts : ndarray, shape (E,)
        Number of spectra that each deviation is the mean of.
    spread, related : float
        See `uplift.fit.library.Family`.
    """

    locations: Array
    deviations: Array
    counts: Array
    spread: float
    related: float


@dataclass(frozen=True, eq=False)
class FamilyKriging:
    """Expected deviation of a material, as the sum of a contribution of each of F families.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b* of the spectra of all families.
    weights : ndarray, shape (E, N)
        Weights of the kernel around each of them.
    family : ndarray of int, shape (E,)
        Row of the family.
    count : int
        Number of families, F.
    """

    locations: Array
    weights: Array
    family: Indices
    count: int

    def contributions(self, lab: Array) -> Array:
        """Contributions (F, n, N) at L*a*b* (n, 3)."""
        rows = [np.flatnonzero(self.family == number) for number in range(self.count)]
        return np.stack([self._sum(lab, self.locations[some], self.weights[some]) for some in rows])

    def __call__(self, lab: Array, relevance: Array) -> Array:
        """Sum of the contributions (n, N) at L*a*b* (n, 3), each times the relevance (F,) of its family."""
        return self._sum(lab, self.locations, self.weights * relevance[self.family][:, None])

    @staticmethod
    def _sum(lab: Array, locations: Array, weights: Array) -> Array:
        sums = np.zeros((len(lab), weights.shape[1]))
        rows = max(BLOCK_NUMBERS // max(len(locations), 1), 1)
        for first in range(0, len(lab) if len(locations) else 0, rows):
            part = slice(first, first + rows)
            sums[part] = _kernel(lab[part], locations) @ weights
        return sums


def krige_families(families: Sequence[FamilySamples]) -> FamilyKriging:
    """Fit the kriging of the deviations of families.

    Parameters
    ----------
    families : sequence of FamilySamples
        F families of any size, also empty.

    Returns
    -------
    FamilyKriging
        Expected deviations.
    """
    from scipy.linalg import cho_factor, cho_solve

    sizes = [len(family.locations) for family in families]
    number = np.repeat(np.arange(len(families)), sizes)
    locations, deviations, counts = (
        np.concatenate([getattr(family, name) for family in families]) for name in ("locations", "deviations", "counts")
    )
    spread = np.array([family.spread for family in families])
    related = np.array([family.related for family in families])
    covariance = _kernel(locations, locations)
    for own in range(len(families)):
        rows = np.flatnonzero(number == own)
        covariance[np.ix_(rows, rows)] *= 1 + spread[own]
    covariance[np.diag_indices(len(number))] += NUGGET / counts
    weights = cho_solve(cho_factor(covariance, overwrite_a=True), deviations)
    weights *= (1 + related * spread)[number][:, None]
    return FamilyKriging(locations, weights, number, len(families))


def average_close(locations: Array, deviations: Array) -> tuple[Array, Array, Array]:
    """Average spectra of close colours, so that at most `MAX_POINTS` remain.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b*.
    deviations : ndarray, shape (E, N)
        Deviations.

    Returns
    -------
    locations : ndarray, shape (k, 3)
        Means.
    deviations : ndarray, shape (k, N)
        Means.
    counts : ndarray, shape (k,)
        Number of spectra in each mean.
    """
    if len(locations) <= MAX_POINTS:
        return locations, deviations, np.ones(len(locations))
    for edge in CELLS:
        _, cell, counts = np.unique(np.floor(locations / edge), axis=0, return_inverse=True, return_counts=True)
        if len(counts) <= MAX_POINTS:
            break
    order = np.argsort(cell.ravel(), kind="stable")
    starts = np.cumsum(counts) - counts
    mean_location, mean_deviation = (
        np.add.reduceat(each[order], starts) / counts[:, None] for each in (locations, deviations)
    )
    return mean_location, mean_deviation, counts.astype(float)


def _kernel(first: Array, second: Array) -> Array:
    from scipy.spatial.distance import cdist

    distance = cdist(first, second)
    distance *= -np.sqrt(3) / LENGTH
    kernel = np.exp(distance)
    kernel *= np.subtract(1, distance, out=distance)
    return kernel
