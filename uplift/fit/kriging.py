"""Kriging of the deviation of atlas entries from a base predictor over CIE L*a*b*
(docs/mathematics.md, 7).

Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25 and 2.26,
and 5.4.2 for leave-one-out.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from uplift.common.arrays import Array, Indices, blocks, distances
from uplift.common.compilation import compiled
from uplift.common.machine import require_xla

METRIC = np.array([0.5, 1.0, 1.0])
"""Weights of differences of L*, a* and b*: materials of one hue are more alike than
those of one lightness.
"""
REACH = 10.0
"""Distance within which the noise of an entry fades away, at most."""
NEARBY = 3.0
"""Reaches of an entry within which materials are trusted to be of its kind."""
WHITE = 0.1
"""Share of the noise of an entry that is white."""
BLOCK_NUMBERS = 1 << 20
"""Numbers of the kernel matrix that are held at a time, at most."""
BLOCK_ROWS = 1 << 13
"""Rows of the kernel matrix that are held at a time, at most."""
MAX_POINTS = 1200
"""Points of a kriging. More spectra are averaged in cubes of L*a*b*."""
CELLS = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
"""Edges of these cubes; the smallest that suffices is taken."""


class Kernel(NamedTuple):
    """Covariance exp(−d / l) + ν √(v v′) ((1 − w) (1 − d / r)⁴₊ (1 + 4 d / r) + w [same
    material]).

    Here l is ``length``, ν ``noise``, r ``reach`` and w `WHITE`.

    The first term is common to the materials of an atlas. The noise ν v belongs to one
    of them: kriging keeps most of it at the colour of an entry and near it, and
    averages it elsewhere. The function of d / r is that of Wendland 1995, "Piecewise
    polynomial, positive definite and compactly supported radial functions of minimal
    degree".
    """

    length: float
    noise: float
    reach: float = REACH


DEFAULT = Kernel(length=12.0, noise=0.3)
"""Kernel of atlases that are too small to learn one."""


class Points(NamedTuple):
    """Mean deviations (P, C) of spectra whose mean locations are (P, 3), their counts
    (P,), and the point of each.
    """

    locations: Array
    deviations: Array
    counts: Array
    point: Indices


def average_close(locations: Array, deviations: Array) -> Points:
    """Average deviations (E, C) of close locations (E, 3), so that at most `MAX_POINTS`
    remain, and count them.

    With cells of the largest edge more may remain.
    """
    if len(locations) <= MAX_POINTS:
        return Points(
            locations, deviations, np.ones(len(locations)), np.arange(len(locations))
        )
    for edge in CELLS:
        _, point, counts = np.unique(
            np.floor(locations / edge), axis=0, return_inverse=True, return_counts=True
        )
        if len(counts) <= MAX_POINTS:
            break
    point = point.ravel()
    order = np.argsort(point, kind="stable")
    starts = np.cumsum(counts) - counts
    location = np.add.reduceat(locations[order], starts) / counts[:, None]
    deviation = np.add.reduceat(deviations[order], starts) / counts[:, None]
    return Points(location, deviation, counts.astype(float), point)


@dataclass(frozen=True, eq=False)
class Kriging:
    """Expected deviation d(x) = s(x) k(x)ᵀ w of E entries, from the locations (P, 3)
    and weights (P, C) of points.

    ``noise`` (P,) are the variances ν v of the points, and ``variances`` (E,) the v of
    the entries. ``trust`` is the share s far from entries: the probability that a
    material is of their kind. It rises to 1 at an entry.
    """

    kernel: Kernel
    locations: Array
    weights: Array
    noise: Array
    variances: Array
    trust: float = 1.0

    def __call__(self, lab: Array) -> Array:
        """Deviation (n, C) at L*a*b* (n, 3)."""
        own = np.sqrt(self.kernel.noise * self.noise)
        sums, nearest = kernel_sums(
            lab * METRIC, self.locations, self.weights, self.kernel, own
        )
        near = _faded(nearest / (NEARBY * self.kernel.reach))
        return (self.trust + (1 - self.trust) * near)[:, None] * sums


def krige(
    lab: Array, deviations: Array, kernel: Kernel, variances: Array | None = None
) -> tuple[Kriging, Array]:
    """Fit the kriging of deviations (E, C) at L*a*b* (E, 3); with it, return its
    leave-one-out errors (E, C).

    ``variances`` (E,) are those of the noise of the entries, relative to that of the
    kernel, 1 by default.
    """
    points = average_close(lab * METRIC, deviations)
    return krige_points(points, deviations, kernel, variances)


def krige_points(
    points: Points, deviations: Array, kernel: Kernel, variances: Array | None = None
) -> tuple[Kriging, Array]:
    """As `krige`, of deviations that are averaged already."""
    variances = np.ones(len(deviations)) if variances is None else variances
    noise = kernel.noise * np.bincount(points.point, variances) / points.counts
    distance = distances(points.locations, points.locations)
    spread = np.sqrt(noise)
    white = WHITE * noise / points.counts
    own = spread * _own(distance, kernel.reach) * spread[:, None]
    precision = np.linalg.inv(_shared(distance, kernel.length) + own + np.diag(white))
    weights = precision @ points.deviations
    # A point of n entries answers its mean less w ν v u / n, where u is its weight, and
    # gives the part h / n of the deviation of an entry to this entry, h = 1 − w ν v
    # K⁻¹_ii / n: without itself, its error is r / (1 − h / n).
    residuals = (
        deviations - (points.deviations - white[:, None] * weights)[points.point]
    )
    others = 1 - (1 - white * np.diag(precision)) / points.counts
    return Kriging(
        kernel, points.locations, weights, noise, variances
    ), residuals / others[points.point, None]


def posterior(kernel: Kernel, known: Array, lab: Array) -> Array:
    """Covariance (n, n) of the deviations of materials at L*a*b* (n, 3), given those of
    known ones (E, 3).

    It is relative to the variance of a material if none is known.
    """
    points = average_close(known * METRIC, np.zeros_like(known))
    at = lab * METRIC

    def covariance(first: Array, second: Array) -> Array:
        distance = distances(first, second)
        return _shared(distance, kernel.length) + kernel.noise * _own(
            distance, kernel.reach
        )

    white = WHITE * kernel.noise
    across = covariance(at, points.locations)
    between = covariance(points.locations, points.locations) + np.diag(
        white / points.counts
    )
    # K(x, x) − K(x, X) K(X, X)⁻¹ K(X, x) (eq. 2.26)
    remaining = (
        covariance(at, at)
        + white * np.eye(len(at))
        - across @ np.linalg.solve(between, across.T)
    )
    return remaining / (1 + kernel.noise)


def kernel_sums(
    at: Array, locations: Array, columns: Array, kernel: Kernel, own: Array
) -> tuple[Array, Array]:
    """Sums (n, K) of columns (P, K) weighted by the kernel at locations (n, 3), and the
    distance (n,) of the nearest location.

    ``own`` (P,) weigh the part of the noise that is not white.
    """
    require_xla()
    rows = max(min(BLOCK_NUMBERS // max(len(locations), 1), BLOCK_ROWS), 1)
    sums = np.empty((len(at), columns.shape[1]))
    nearest = np.empty(len(at))
    with jax.enable_x64(True):
        for block in blocks(len(at), rows):
            count = block.stop - block.start
            some = at[block]
            if count < rows:
                some = np.resize(some, (rows, 3))  # one shape is compiled
            arrays = _kernel_block(kernel, own, some, locations, columns)
            sums[block], nearest[block] = (
                np.asarray(array)[:count] for array in arrays
            )
    return sums, nearest


@compiled
def _kernel_block(
    kernel: Kernel,
    own: jax.Array,
    at: jax.Array,
    locations: jax.Array,
    columns: jax.Array,
) -> tuple[jax.Array, jax.Array]:
    # By components: three times faster than a sum over an axis of three
    distance = jnp.sqrt(
        sum((at[:, axis, None] - locations[:, axis]) ** 2 for axis in range(3))
    )
    weights = _shared(distance, kernel.length) + own * _own(distance, kernel.reach)
    return weights @ columns, distance.min(axis=1)


def _shared(distance: Any, length: float) -> Any:
    """Covariance that the materials share at distances, an array of numpy or JAX."""
    return distance.__array_namespace__().exp(distance / -length)


def _own(distance: Any, reach: float) -> Any:
    """Covariance of the noise that is not white, of variance 1, likewise."""
    return (1 - WHITE) * _faded(distance / reach)


def _faded(relative: Any) -> Any:
    """Wendland's (1 − x)⁴₊ (1 + 4 x), an array of numpy or JAX."""
    within = relative.__array_namespace__().minimum(relative, 1.0)
    fade = (1 - within) ** 2
    return fade * fade * (1 + 4 * within)
