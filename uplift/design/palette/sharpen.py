"""Sharpening: the transform of a basis in which products of spectra are nearly products of coefficients.

The papers leave the choice of the transform to an optimisation. Here it minimises the colour errors of products.

References
----------
S. Bergner, T. Möller, M. S. Drew, *A Spectral Engine for Visualization*, 2004, section 2.2.
M. S. Drew, G. D. Finlayson, "Multispectral processing without spectra", JOSA A 20(7), 2003.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.threads import single_threaded_blas
from uplift.design.palette.colours import lab_per_rgb, screen_matrix
from uplift.design.palette.light_paths import LightPaths

OUTLIER = 2.0
"""L*a*b* error above which the loss grows linearly, so that no single light dominates."""
MAX_ITERATIONS = 100


def sharpen(sensor: Sensor, basis: Array, projection: Array, paths: LightPaths) -> Array:
    """Transform T (m, m) of coefficients; the sharpened basis is ``basis @ inv(T)``.

    T minimises the L*a*b* errors of products over ``paths`` among the transforms that give the flat spectrum
    coefficients of 1, so that white leaves colours unchanged. It is invertible and keeps the span of the basis.

    Parameters
    ----------
    sensor : Sensor
        Wavelengths, observer and RGB space.
    basis : ndarray, shape (N, m)
        Principal basis.
    projection : ndarray, shape (m, N)
        Its inverse on the span.
    paths : LightPaths
        Products whose colours are fitted.
    """
    from scipy.linalg import null_space
    from scipy.optimize import least_squares

    white = projection.sum(axis=1)
    free = null_space(white[None])
    problem = _make_problem(sensor, basis, projection, paths, free)
    start = _initial_transform(basis, projection) @ free
    with single_threaded_blas():
        result = least_squares(
            problem.residuals,
            start.ravel(),
            jac=problem.jacobian,
            loss="soft_l1",
            f_scale=OUTLIER,
            max_nfev=MAX_ITERATIONS,
        )
    return problem.transform(result.x)


def _initial_transform(basis: Array, projection: Array) -> Array:
    """Transform (m, m) to the spectrum's values at m wavelengths, where products are exact."""
    from scipy.linalg import qr

    order = qr(projection, pivoting=True, mode="r")[1]
    return basis[np.sort(order[: basis.shape[1]])]


def _make_problem(
    sensor: Sensor, basis: Array, projection: Array, paths: LightPaths, free: Array
) -> _SharpeningProblem:
    white, screen = projection.sum(axis=1), screen_matrix(sensor)
    target = paths.signals @ screen.T
    return _SharpeningProblem(
        fixed=np.outer(np.ones_like(white), white) / (white @ white),
        free=free,
        factors=paths.factors @ projection.T,
        to_rgb=screen @ basis,
        target=target,
        weights=lab_per_rgb(sensor, target),
    )


@dataclass(frozen=True, eq=False)
class _SharpeningProblem:
    """Residuals as a function of Z (m, m − 1), T = fixed + Z freeᵀ: the transforms that keep white at 1.

    ``factors`` (k, n, m) are principal coefficients, ``to_rgb`` (3, m) gives their RGB, ``target`` (n, 3) is the RGB
    of the full spectra, ``weights`` (n, 3, 3) the derivative of L*a*b* by RGB.
    """

    fixed: Array
    free: Array
    factors: Array
    to_rgb: Array
    target: Array
    weights: Array

    def transform(self, z: Array) -> Array:
        return self.fixed + z.reshape(self.free.shape) @ self.free.T

    def residuals(self, z: Array) -> Array:
        transform = self.transform(z)
        product = (self.factors @ transform.T).prod(axis=0)
        rgb = product @ np.linalg.inv(transform).T @ self.to_rgb.T
        return np.einsum("nij,nj->ni", self.weights, rgb - self.target).ravel()

    def jacobian(self, z: Array) -> Array:
        """Derivative (3n, m(m − 1)): through every factor, and through the inverse transform."""
        transform = self.transform(z)
        inverse = np.linalg.inv(transform)
        sharp = self.factors @ transform.T
        principal = sharp.prod(axis=0) @ inverse.T
        by_transform = -principal[:, None, :] + np.einsum("kna,knb->nab", _products_of_others(sharp), self.factors)
        lab = self.weights @ (self.to_rgb @ inverse)
        jacobian = np.einsum("nia,nac->niac", lab, by_transform @ self.free)
        return jacobian.reshape(3 * len(principal), self.free.size)


def _products_of_others(factors: Array) -> Array:
    """Product (k, n, m) of all factors but one, without division, as coefficients may be 0."""
    return np.stack([np.delete(factors, k, axis=0).prod(axis=0) for k in range(len(factors))])
