"""Sharpening: the transform of a basis in which products of spectra are nearly products
of coefficients.

The papers leave the choice of the transform to an optimisation. Here it minimises the
colour errors of products over light paths: a light and up to three reflections.

S. Bergner, T. Möller, M. S. Drew, 2004, section 2.2; M. S. Drew, G. D. Finlayson, JOSA
A 20(7), 2003.
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.machine import single_threaded_blas
from uplift.extras.papers.palette.colours import lab_per_rgb, screen_matrix

MAX_REFLECTIONS = 3
# L*a*b* error above which the loss grows linearly, so that no single light dominates
OUTLIER = 2.0
MAX_ITERATIONS = 100


def make_light_paths(reflectances: Array, lights: Array) -> Array:
    """Return the factors (MAX_REFLECTIONS + 1, n, N) of paths, from lights (L, N) and
    reflectances (E, N).

    A light comes first, then one to three reflectances, two of them random, then ones.
    Their product reaches the eye.
    """
    rng = np.random.default_rng(0)
    white = np.ones_like(reflectances)
    paths = []
    for light in lights:
        power = np.broadcast_to(light, reflectances.shape)
        others = [
            reflectances[rng.permutation(len(reflectances))]
            for _ in range(MAX_REFLECTIONS - 1)
        ]
        surfaces = [reflectances, *others]
        for count in range(1, MAX_REFLECTIONS + 1):
            whites = [white] * (MAX_REFLECTIONS - count)
            paths.append([power, *surfaces[:count], *whites])
    return np.concatenate(paths, axis=1)


def sharpen(sensor: Sensor, basis: Array, projection: Array, paths: Array) -> Array:
    """Compute the transform T (m, m) of coefficients; the sharpened basis is ``basis @
    inv(T)``.

    T minimises the L*a*b* errors of products over ``paths`` (k, n, N) among the
    transforms that give the flat spectrum coefficients of 1. It keeps the span of the
    basis (N, m), whose coefficients ``projection`` (m, N) gives.
    """
    from scipy.linalg import null_space, qr
    from scipy.optimize import least_squares

    white = projection.sum(axis=1)
    screen = screen_matrix(sensor)
    target = paths.prod(axis=0) @ screen.T
    problem = SharpeningProblem(
        fixed=np.outer(np.ones_like(white), white) / (white @ white),
        free=null_space(white[None]),
        factors=paths @ projection.T,
        to_rgb=screen @ basis,
        target=target,
        weights=lab_per_rgb(sensor, target),
    )
    # Start from the spectrum's values at m wavelengths, where products are exact.
    order = qr(projection, pivoting=True, mode="r")[1]
    start = basis[np.sort(order[: basis.shape[1]])] @ problem.free
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


@dataclass(frozen=True, eq=False)
class SharpeningProblem:
    """Residuals as a function of Z (m, m − 1), T = fixed + Z freeᵀ: the transforms that
    keep white at 1.
    """

    fixed: Array  # (m, m)
    free: Array  # (m, m − 1)
    factors: Array  # (k, n, m) principal coefficients of the factors of n paths
    to_rgb: Array  # (3, m) from principal coefficients to RGB
    target: Array  # (n, 3) RGB of the full spectra
    weights: Array  # (n, 3, 3) derivative of L*a*b* by RGB

    def transform(self, z: Array) -> Array:
        """Return T for Z as a vector."""
        return self.fixed + z.reshape(self.free.shape) @ self.free.T

    def residuals(self, z: Array) -> Array:
        """Return the L*a*b* errors (3n,) of products of sharpened coefficients."""
        transform = self.transform(z)
        product = (self.factors @ transform.T).prod(axis=0)
        rgb = product @ np.linalg.inv(transform).T @ self.to_rgb.T
        return np.einsum("nij,nj->ni", self.weights, rgb - self.target).ravel()

    def jacobian(self, z: Array) -> Array:
        """Return the derivative (3n, m(m − 1)): through every factor, and through the
        inverse transform.
        """
        transform = self.transform(z)
        inverse = np.linalg.inv(transform)
        sharp = self.factors @ transform.T
        # Products of all factors but one, without division, as coefficients may be 0.
        others = np.stack(
            [np.delete(sharp, k, axis=0).prod(axis=0) for k in range(len(sharp))]
        )
        principal = sharp.prod(axis=0) @ inverse.T
        by_transform = -principal[:, None, :] + np.einsum(
            "kna,knb->nab", others, self.factors
        )
        lab = self.weights @ (self.to_rgb @ inverse)
        jacobian = np.einsum("nia,nac->niac", lab, by_transform @ self.free)
        return jacobian.reshape(3 * len(principal), self.free.size)
