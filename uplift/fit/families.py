"""Families of measured materials, which shape the prior but do not constrain the cube
(docs/prior.md).

The deviation of a material of family f at the colour x is d(x) + d_f(x) + noise. d and
d_f are independent Gaussian processes over CIE L*a*b* with the same Matérn correlation;
their variances are 1 and the spread of the family. What is expected of a material of no
known family is E[d(x)], so a large family does not outweigh several small ones.

With an atlas, the relevance of each family is learnt: the factor of its contribution
with which it explains the entries. Relevances are supposed to vary about 1, and to vary
less than differences that no family explains are large: atlases of many entries, and
those which families explain well, decide; others leave relevances near 1.

Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25 and 4.17
(ν = 3/2); 2.1 for the ridge.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from importlib.resources import files

import numpy as np

from uplift.colorimetry.delta_e import lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices, blocks, distances
from uplift.common.errors import unknown_name
from uplift.fit.entries import LIGHTS_WEIGHT
from uplift.fit.kriging import Kernel, Points

FILE = "library.npz"
"""Package data, written by tools/ship_library.py."""
STAND_IN = "otsu2018"
"""Family that stands for measurements of the Munsell book, which cannot be shipped."""
STEPS = 10_000
"""Steps of reflectance from 0 to 1 in the file."""
LENGTH = 20.0
"""Correlation length in CIE L*a*b*: docs/prior.md."""
NUGGET = 0.3
"""Variance of the noise of a material, relative to that of the shared deviation."""
BLOCK_NUMBERS = 1 << 17
"""Numbers of the kernel matrix held at a time."""
VARIANCE = 0.5
"""Assumed variance of relevances about 1. Halves of ColorCheckers prefer 1 or more,
those of mixed sets less.
"""
CORRELATED = Kernel(length=24.0, noise=1.0)
"""Covariance of the deviations of entries that no family explains: that of close
colours is left to the kriging.
"""
MAX_RELEVANCE = 4.0


@dataclass(frozen=True, eq=False)
class Family:
    """Spectra (E, N) measured together, which deviate from smooth spectra in a common
    way.

    ``spread`` is the variance of the family's own deviation, relative to that of the
    deviation which all materials share. ``related``, 0 to 1, is the part of it that the
    materials of a cube are expected to have as well: 0 for a family like any other, 1
    for the family that they belong to.
    """

    name: str
    measured: Array
    spread: float
    related: float = 0.0


def shipped_library(leave_out: Collection[str] = ()) -> tuple[Family, ...]:
    """Return the families that come with the package, at the wavelengths of the default
    sensor.

    Some may be left out by name, for tests on them. Raises `UnknownNameError` for an
    unknown name.
    """
    with (
        (files(__package__) / FILE).open("rb") as file,
        np.load(file, allow_pickle=False) as table,
    ):
        measured = np.cumsum(table["steps"], axis=1, dtype=np.int64) / STEPS
        rows = np.split(measured, np.cumsum(table["counts"])[:-1])
        named = zip(
            table["names"].tolist(), rows, table["spreads"].tolist(), strict=True
        )
        families = {name: Family(name, *columns) for name, *columns in named}
    for name in leave_out:
        if name not in families:
            raise unknown_name(name, list(families), "library family")
    return tuple(family for family in families.values() if family.name not in leave_out)


@dataclass(frozen=True, eq=False)
class FamilyKriging:
    """Expected deviation of a material, as the sum of a contribution of each of
    ``count`` families.

    The spectra of all families have L*a*b* (E, 3), kriging weights (E, N) and the row
    of their family (E,).
    """

    locations: Array
    weights: Array
    family: Indices
    count: int

    def contributions(self, lab: Array) -> Array:
        """Contributions (F, n, N) at L*a*b* (n, 3)."""
        parts = []
        for number in range(self.count):
            rows = np.flatnonzero(self.family == number)
            parts.append(_kernel_sum(lab, self.locations[rows], self.weights[rows]))
        return np.stack(parts)

    def __call__(self, lab: Array, relevance: Array) -> Array:
        """Sum of the contributions (n, N) at L*a*b* (n, 3), each times the relevance
        (F,) of its family.
        """
        weights = self.weights * relevance[self.family][:, None]
        return _kernel_sum(lab, self.locations, weights)


def krige_families(
    families: Sequence[Family], samples: Sequence[Points]
) -> FamilyKriging:
    """Fit the kriging of families to their deviations at L*a*b*, of which each family
    may have any number, also 0.
    """
    number = np.repeat(
        np.arange(len(families)), [len(points.counts) for points in samples]
    )
    locations, deviations, counts, _ = (
        np.concatenate(columns) for columns in zip(*samples, strict=True)
    )
    spread = np.array([family.spread for family in families])
    related = np.array([family.related for family in families])
    # Covariance of samples i, j: (1 + spread_f) k_ij within a family, k_ij between
    # families, noise on the diagonal.
    covariance = _matern(locations, locations)
    for row in range(len(families)):
        rows = np.flatnonzero(number == row)
        covariance[np.ix_(rows, rows)] *= 1 + spread[row]
    covariance[np.diag_indices(len(number))] += NUGGET / counts
    weights = np.linalg.solve(covariance, deviations)
    # Their covariance with a new material, whose deviation is d(x) and the related part
    # of d_f(x).
    weights *= (1 + related * spread)[number][:, None]
    return FamilyKriging(locations, weights, number, len(families))


def _kernel_sum(lab: Array, locations: Array, weights: Array) -> Array:
    """Sums (n, N) of weights (E, N) at L*a*b* (n, 3)."""
    sums = np.zeros((len(lab), weights.shape[1]))
    size = max(BLOCK_NUMBERS // max(len(locations), 1), 1)
    for block in blocks(len(lab) if len(locations) else 0, size):
        sums[block] = _matern(lab[block], locations) @ weights
    return sums


def _matern(first: Array, second: Array) -> Array:
    """Matérn correlation (n, m) with ν = 3/2: (1 + √3 d / l) exp(−√3 d /
    l), in place.
    """
    distance = distances(first, second)
    distance *= -np.sqrt(3) / LENGTH
    kernel = np.exp(distance)
    kernel *= np.subtract(1, distance, out=distance)
    return kernel


def learn_relevance(
    lights: Sequence[Light],
    locations: Array,
    plain: Array,
    parts: Array,
    measured: Array,
) -> Array:
    """Learn relevances (F,) of families by bounded generalised least squares, which
    shrinks them towards 1.

    Entries at L*a*b* (n, 3) have ``measured`` reflectances (n, N). Without families
    ``plain`` (n, N) are expected, and ``parts`` (F, n, N) are the contributions of the
    families. Residuals are differences of spectra and of their colours under the
    lights; those of entries of close colours are correlated.
    """
    assumed = np.ones(len(parts))
    if not len(measured):
        return assumed
    matrices = np.stack([light.xyz for light in lights])
    whites = np.stack([light.white for light in lights])
    expected = np.clip(plain + parts.sum(axis=0), 0, 1)
    to_lab = LIGHTS_WEIGHT * lab_jacobian(
        (expected @ matrices.mT).swapaxes(0, 1), whites
    )
    shared = np.exp(distances(locations, locations) / -CORRELATED.length)
    covariance = shared + CORRELATED.noise * np.eye(len(locations))
    root = np.linalg.cholesky(covariance / (1 + CORRELATED.noise))

    def independent(change: Array) -> Array:
        """Weighted differences (n, N + 3 L) of spectra as in the objective of entries,
        made independent by L⁻¹.
        """
        xyz = (change @ matrices.mT).swapaxes(0, 1)
        colours = (to_lab @ xyz[..., None])[..., 0].reshape(len(change), -1)
        features = np.concatenate([change / np.sqrt(change.shape[1]), colours], axis=1)
        return np.linalg.solve(root, features)

    columns = np.stack([independent(part).ravel() for part in parts], axis=1)
    unexplained = independent(measured - plain)
    # Differences at neighbouring wavelengths, and of colours, are a few independent
    # ones many times over: as many as their covariance has large eigenvalues, (Σ λ)² /
    # Σ λ². So the variance of one is Σ λ² / Σ λ / n.
    residuals = unexplained - (columns @ assumed).reshape(unexplained.shape)
    products = residuals.T @ residuals
    total = np.trace(products)
    if not columns.any() or not total:
        return assumed
    noise = float((products**2).sum() / total / len(residuals))
    ridge = np.sqrt(noise / VARIANCE)  # noise over assumed variance
    rows = np.concatenate([columns, ridge * np.eye(len(parts))])
    goal = np.concatenate([unexplained.ravel(), ridge * assumed])
    q, r = np.linalg.qr(rows)
    unbounded = np.linalg.solve(r, q.T @ goal)
    if ((unbounded >= 0) & (unbounded <= MAX_RELEVANCE)).all():
        return unbounded
    from scipy.optimize import lsq_linear

    return lsq_linear(r, q.T @ goal, bounds=(0, MAX_RELEVANCE), method="bvls").x
