"""Expected errors of predicted colours, learnt from measurements that were left out
(docs/mathematics.md, 7).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, blocks, distances

LENGTH = 6.0
"""Length in CIE L*a*b* of the weights exp(−ΔE / length) of the errors of entries around
a colour.
"""
PRIOR_COUNT = 2.0
"""Weight of the mean error of all entries, in entries."""
COVERAGE = ((0.68, 1.0), (0.95, 2.0))
"""Shares of materials within the standard error and within the error bound; their radii
if errors were normal.
"""
TRUST = 20.0
"""Entries at which half of the difference from Student's distribution is applied, on a
logarithmic scale.
"""
MIN_VARIANCE = 0.02
"""Lower limit of the variance assigned to a left-out entry."""
FAMILIAR = 0.95
"""Share of the entries that are nearer to another one than colours that are like the
atlas may be.
"""
BLOCK_NUMBERS = 1 << 17
"""Numbers of the matrix of weights held at a time."""
TINY = np.finfo(float).tiny
MAX_ROWS = 1000
"""Entries that the distances between neighbours are learnt from, at most."""


@dataclass(frozen=True, eq=False, repr=False)
class LeftOut:
    """Measured materials, and what is answered to their colours without their
    families.
    """

    rgb: Array
    """(M, 3) linear RGB in [0, 1]."""
    family: Array
    """(M,) number of the family of each material."""
    measured: Array
    """(M, N) reflectances as measured."""
    predicted: Array
    """(M, N) reflectances without the family."""
    names: tuple[str, ...] = ()
    """Names of the families, by number."""


@dataclass(frozen=True, eq=False, repr=False)
class ExpectedError:
    """Expected squares of errors around left-out entries, and the radii that errors
    stay within.
    """

    locations: Array
    """(E, 3) CIE L*a*b* of the entries."""
    columns: Array
    """(E, K + 1) Squares or products of the errors of each entry when left out, per
    unit of variance, and 1.
    """
    floor: Array
    """(K,) Squares or products that remain at the entries themselves."""
    left_out: Array
    """(E, K) Expected squares or products of each entry when left out, from the other
    entries.
    """
    radii: tuple[float, float]
    """Radii in roots of the expected squares that 68 % and 95 % of materials stay
    within; normal errors: 1 and 2.
    """
    likeness: float = 1.0
    """Correlation of a material with an entry of its colour: 1 where that is answered
    with the entry, 0 where it is not.
    """

    @property
    def scale(self) -> float:
        """Factor of the normal distribution that fits both radii."""
        standard, bound = self.radii
        return float(np.sqrt((standard**2 + (bound / COVERAGE[1][1]) ** 2) / 2))

    def combine(self, sums: Array, nearest: Array) -> Array:
        """Squares (n, K) less `floor` from weighted sums (n, K + 1) of `columns`, and
        the largest weights (n,).
        """
        # v(x) (Σ k e² + n₀ mean e²) / (Σ k + n₀), with v = 1 − (c k)² of the nearest
        # entry and its likeness c
        spread = (sums[:, :-1] + PRIOR_COUNT * self.columns[:, :-1].mean(axis=0)) / (
            sums[:, -1:] + PRIOR_COUNT
        )
        return (1 - (self.likeness * nearest[:, None]) ** 2) * spread

    def __call__(self, lab: Array) -> Array:
        """Expected squares (n, K) less `floor` at L*a*b* (n, 3)."""
        squares = np.empty((len(lab), len(self.floor)))
        for block in blocks(len(lab), max(BLOCK_NUMBERS // len(self.locations), 1)):
            weights = np.exp(distances(lab[block], self.locations) / -LENGTH)
            squares[block] = self.combine(weights @ self.columns, weights.max(axis=1))
        return squares


def expected_error(
    locations: Array,
    left_out: Array,
    kept: Array,
    products: tuple[Array, Array] | None = None,
    family: Array | None = None,
) -> ExpectedError:
    """Learn from the ΔE00 (E,) of entries at L*a*b* (E, 3), when left out and when
    kept.

    What is learnt are the ``products`` (E, K) of errors, in both cases, by default
    their squares. Entries of a ``family`` (E,) are left out together, and colours are
    not answered with them.
    """
    likeness = 1.0
    if family is not None:
        likeness = 0.0
    left_out_products, kept_products = products or (
        left_out[:, None] ** 2,
        kept[:, None] ** 2,
    )
    parts = list(blocks(len(locations), max(BLOCK_NUMBERS // len(locations), 1)))

    def others(block: slice) -> Array:
        apart = distances(locations[block], locations)
        if family is None:
            np.fill_diagonal(apart[:, block], np.inf)
        else:
            apart[family[block, None] == family] = np.inf
        return apart

    # The variance v = 1 − (c k)² that a left-out entry has, by the weight k = exp(−ΔE /
    # length) of the nearest other one
    nearest = np.concatenate([others(block).min(axis=1) for block in parts])
    near = likeness * np.exp(nearest / -LENGTH)
    variance = np.maximum(1 - near**2, MIN_VARIANCE)
    floor = (kept**2).mean()
    products_floor = kept_products.mean(axis=0)
    # Part of each square that the other entries explain, per unit of variance: (e² − f)
    # / v e².
    share = np.maximum(1 - floor / np.maximum(left_out**2, TINY), 0) / variance
    columns = np.column_stack(
        [left_out_products * share[:, None], left_out**2 * share, np.ones(len(share))]
    )
    # What the other entries let expect: v (Σ k e² + n₀ mean e²) / (Σ k + n₀) + f
    sums = np.concatenate(
        [np.exp(others(block) / -LENGTH) @ columns for block in parts]
    )
    expected = sums[:, :-1] + PRIOR_COUNT * columns[:, :-1].mean(axis=0)
    expected *= (variance / (sums[:, -1] + PRIOR_COUNT))[:, None]
    roots = np.sqrt(expected[:, -1] + floor)
    standard, bound = learn_radii(left_out / np.maximum(roots, TINY), COVERAGE)
    columns = np.delete(columns, -2, axis=1)
    return ExpectedError(
        locations,
        columns,
        floor=products_floor,
        left_out=expected[:, :-1] + products_floor,
        radii=(standard, bound),
        likeness=likeness,
    )


def learn_radii(
    ratio: Array, coverage: Sequence[tuple[float, float]], components: int = 1
) -> list[float]:
    """Learn radii that shares of left-out entries stay within, from their errors over
    the expected ones (E,).

    ``coverage`` pairs a share with its radius if errors of that many ``components``
    were normal. Errors have heavier tails. Quantiles are at k / (E + 1), as in
    conformal prediction: they hold on average for one more entry.
    """
    count = len(ratio)
    trust = count / (count + TRUST)
    radii = []
    for share, normal in coverage:
        # Errors in units of a scale that is known from E of them have Student's
        # distribution (Abramowitz & Stegun 1964, "Handbook of mathematical functions",
        # 26.7.5, to first order in 1 / E).
        student = normal * (1 + (normal**2 + components) / (4 * count))
        observed = float(np.quantile(ratio, share, method="weibull"))
        radii.append(
            student * (observed / student) ** trust if observed > 0 else normal
        )
    return radii


def nearest_distances(lab: Array, locations: Array) -> Array:
    """ΔE*ab (n,) from L*a*b* (n, 3) to the nearest of the entries (E, 3); infinite
    without entries.
    """
    if not len(locations):
        return np.full(len(lab), np.inf)
    nearest = np.empty(len(lab))
    for block in blocks(len(lab), max(BLOCK_NUMBERS // len(locations), 1)):
        nearest[block] = distances(lab[block], locations).min(axis=1)
    return nearest


def familiar_distance(locations: Array) -> float:
    """ΔE*ab within which `FAMILIAR` of the entries at L*a*b* (E, 3) have another one; 0
    for fewer than two.
    """
    if len(locations) < 2:
        return 0.0
    step = -(-len(locations) // MAX_ROWS)
    rows = np.arange(0, len(locations), step)
    apart = distances(locations[rows], locations)
    apart[np.arange(len(rows)), rows] = np.inf
    # The quantile by numpy imports its masked arrays, for which a query would wait.
    nearest = np.sort(apart.min(axis=1))
    return float(np.interp(FAMILIAR * (len(rows) - 1), np.arange(len(rows)), nearest))
