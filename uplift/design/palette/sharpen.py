"""Sharpening: the transform of a basis in which products of spectra are products of coefficients.

Bergner, Möller & Drew 2004, 2.2, after Drew & Finlayson, "Multispectral processing without spectra", JOSA A 20(7),
2003. Which transform is best they leave to an optimisation; here it is the one whose colours are nearest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.threads import single_threaded_blas
from uplift.design.palette.bounces import Bounces
from uplift.design.palette.colours import lab_per_rgb, screen_matrix

OUTLIER = 2.0
"""L*a*b* errors beyond this count less than by their square: no single light may decide."""
MOST_STEPS = 100


def sharpen(sensor: Sensor, basis: Array, projection: Array, ways: Bounces) -> Array:
    """(m, m) transform T of coefficients, T c: the sharpened basis is ``basis @ inv(T)``.

    Of all transforms that give the flat spectrum coefficients of 1, so that white changes nothing, the one that
    minimises the L*a*b* errors of products over ``ways``. It is invertible, so nothing of the span is lost.

    Parameters
    ----------
    basis : (N, m); projection : (m, N) its inverse on the span.
    """
    from scipy.linalg import null_space
    from scipy.optimize import least_squares

    white = projection.sum(axis=1)
    free = null_space(white[None])
    task = _task(sensor, basis, projection, ways, free)
    start = _peaks(basis, projection) @ free
    with single_threaded_blas():
        found = least_squares(
            task.residuals,
            start.ravel(),
            jac=task.slope,
            loss="soft_l1",
            f_scale=OUTLIER,
            max_nfev=MOST_STEPS,
        )
    return task.transform(found.x)


def _peaks(basis: Array, projection: Array) -> Array:
    """(m, m) the transform to the spectrum's values at m wavelengths: there products are exact."""
    from scipy.linalg import qr

    order = qr(projection, pivoting=True, mode="r")[1]
    return basis[np.sort(order[: basis.shape[1]])]


def _task(sensor: Sensor, basis: Array, projection: Array, ways: Bounces, free: Array) -> _Task:
    white, screen = projection.sum(axis=1), screen_matrix(sensor)
    wanted = ways.signals @ screen.T
    return _Task(
        fixed=np.outer(np.ones_like(white), white) / (white @ white),
        free=free,
        factors=ways.factors @ projection.T,
        colours=screen @ basis,
        wanted=wanted,
        weights=lab_per_rgb(sensor, wanted),
    )


@dataclass(frozen=True, eq=False)
class _Task:
    """Residuals as a function of Z (m, m − 1), T = fixed + Z freeᵀ: the rows of T that keep white at 1.

    ``factors`` (k, n, m) are coefficients before sharpening, ``colours`` (3, m) their RGB, ``wanted`` (n, 3) the RGB
    of the full spectra, ``weights`` (n, 3, 3) L*a*b* per RGB.
    """

    fixed: Array
    free: Array
    factors: Array
    colours: Array
    wanted: Array
    weights: Array

    def transform(self, unknown: Array) -> Array:
        return self.fixed + unknown.reshape(self.free.shape) @ self.free.T

    def residuals(self, unknown: Array) -> Array:
        transform = self.transform(unknown)
        product = (self.factors @ transform.T).prod(axis=0)
        rgb = product @ np.linalg.inv(transform).T @ self.colours.T
        return np.einsum("nij,nj->ni", self.weights, rgb - self.wanted).ravel()

    def slope(self, unknown: Array) -> Array:
        """Derivative (3n, m(m − 1)): through every factor, and through the way back."""
        transform = self.transform(unknown)
        inverse = np.linalg.inv(transform)
        sharp = self.factors @ transform.T
        back = sharp.prod(axis=0) @ inverse.T
        by_transform = -back[:, None, :] + np.einsum("kna,knb->nab", _others(sharp), self.factors)
        lab = self.weights @ (self.colours @ inverse)
        return np.einsum("nia,nac->niac", lab, by_transform @ self.free).reshape(
            3 * len(back), self.free.size
        )


def _others(factors: Array) -> Array:
    """(k, n, m) for every factor the product of the others; no division, as coefficients may be 0."""
    return np.stack([np.delete(factors, k, axis=0).prod(axis=0) for k in range(len(factors))])
