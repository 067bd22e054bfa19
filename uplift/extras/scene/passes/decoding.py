"""Decoding matrices and the numbers of lights, by least squares over paths of light.

Let x (K,) be the numbers of a path under a light of ones, l (K,) those of the light,
and t its XYZ. Decoding by D (3, K) has the error D (l ∘ x) − t, whose form G
approximates ΔE00². Sums over paths enter by their Gram matrices alone:

    C_ab = Σ G_ab x xᵀ  (K, K),    r_a = Σ (G t)_a x  (K,).

For given l the objective is quadratic in D, for given D in l; they are minimised in
turn. Numbers of lights are positive, as renderers need: one that reached 0 would stay
there, as D then ignores its light.
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.scene.passes.light_paths import LightPaths

RIDGE = 1e-9
"""Part of the mean diagonal that is added to the diagonal of normal equations."""


@dataclass(frozen=True, eq=False)
class Grams:
    """Sums over the paths of each of L lights: ``products`` C (L, 3, 3, K, K),
    ``targets`` r (L, 3, K), and ``constant`` Σ tᵀ G t of all.
    """

    products: Array
    targets: Array
    constant: float
    paths: int

    @classmethod
    def of(cls, paths: LightPaths, numbers: Array) -> "Grams":
        """Sum over paths with numbers (n, K)."""
        metric = paths.metric
        lights = len(metric)
        bands = numbers.shape[1]
        products = np.empty((lights, 3, 3, bands, bands))
        for a in range(3):
            for b in range(a, 3):
                weighted = numbers.T * metric[:, None, :, a, b]
                products[:, a, b] = weighted @ numbers
                products[:, b, a] = products[:, a, b]
        pulled = (metric @ paths.xyz[..., None])[..., 0]
        targets = pulled.mT @ numbers
        constant = float((pulled * paths.xyz).sum())
        return cls(products, targets, constant, metric.shape[0] * metric.shape[1])

    def decoding(self, numbers: Array, lights: slice = slice(None)) -> Array:
        """Return the matrix D (3, K) that lights, with numbers (L, K), share."""
        numbers = numbers[lights]
        products = self.products[lights]
        count = 3 * numbers.shape[1]
        normal = np.einsum("lk,lm,labkm->akbm", numbers, numbers, products)
        right = np.einsum("lk,lak->ak", numbers, self.targets[lights])
        solution = _solve(normal.reshape(count, count), right.ravel())
        return solution.reshape(3, -1)

    def decodings(self, numbers: Array) -> Array:
        """Return a matrix (L, 3, K) for each light with numbers (L, K)."""
        rows = range(len(numbers))
        return np.stack([self.decoding(numbers, slice(row, row + 1)) for row in rows])

    def light_numbers(self, decoding: Array, floor: Array) -> tuple[Array, float]:
        """Return the numbers (L, K), at least ``floor``, that suit a matrix D (3, K),
        and the root mean square of ΔE00.
        """
        normal = np.einsum("ak,bm,labkm->lkm", decoding, decoding, self.products)
        right = np.einsum("ak,lak->lk", decoding, self.targets)
        lights = zip(normal, right, floor, strict=True)
        numbers = np.stack([_bounded(*light) for light in lights])
        linear = (numbers * right).sum()
        quadratic = np.einsum("lk,lm,lkm->", numbers, numbers, normal)
        total = self.constant - 2 * linear + quadratic
        return numbers, float(np.sqrt(max(total, 0.0) / self.paths))

    def alternate(
        self, numbers: Array, floor: Array, rounds: int
    ) -> tuple[Array, Array, float]:
        """Fit D (3, K) and the numbers of lights in turn, from numbers (L, K) on, which
        stay above ``floor``. Return both, and the root mean square of ΔE00.
        """
        error = np.inf
        decoding = np.zeros((3, numbers.shape[1]))
        for _ in range(rounds):
            decoding = self.decoding(numbers)
            numbers, error = self.light_numbers(decoding, floor)
        return decoding, numbers, error


def _solve(normal: Array, right: Array) -> Array:
    ridge = RIDGE * np.trace(normal) / len(normal)
    return np.linalg.solve(normal + ridge * np.eye(len(normal)), right)


def _bounded(normal: Array, right: Array, floor: Array) -> Array:
    """Minimise xᵀ N x / 2 − rᵀ x over x ≥ floor, for N (K, K) and r (K,)."""
    free = _solve(normal, right)
    if (free >= floor).all():
        return free
    from scipy.optimize import nnls

    ridge = RIDGE * np.trace(normal) / len(normal)
    factor = np.linalg.cholesky(normal + ridge * np.eye(len(normal)))
    above = nnls(factor.T, np.linalg.solve(factor, right - normal @ floor))[0]
    return floor + above


def light_projection(paths: LightPaths, numbers: Array, decoding: Array) -> Array:
    """Compute the matrix (K, 81) from the power of any light to its numbers.

    Powers have Y = 1 as ``power @ cmfs[:, 1]``. Monochromatic light of each
    wavelength gets the numbers with which D decodes its paths best, by least squares
    under the mean metric of the lights. The map is linear: lights mix as their numbers
    do. Numbers of nearly monochromatic lights may be negative.
    """
    metric = paths.metric.mean(axis=0)
    decoded = decoding[:, None, :] * numbers  # (3, n, K): D diag(x)
    weighted = np.einsum("nab,bnk->ank", metric, decoded)
    normal = np.einsum("ank,anm->km", weighted, decoded)
    # The XYZ of a path at one wavelength are cmfs times its reflectance there.
    cmfs = observer.matching_functions()
    right = np.einsum("ank,wa,nw->kw", weighted, cmfs, paths.reflected, optimize=True)
    return _solve(normal, right)
