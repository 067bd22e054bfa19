"""Relevance of families: factors of their contributions with which they explain the entries of an atlas.

Relevances are supposed to vary about 1, and to vary less than differences that no family explains are large: atlases of
many entries, and those which families explain well, decide; others leave relevances near 1 (docs/prior.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from uplift.colorimetry.delta_e import lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.fit.kriging import JITTER, Kernel
from uplift.fit.objective import BALANCED

VARIANCE = 0.5
"""Assumed variance of relevances about 1. Halves of ColorCheckers prefer 1 or more, those of mixed sets less."""
CORRELATED = Kernel(length=24.0, nugget=1.0)
"""Covariance of the deviations of entries that no family explains: that of close colours is left to the kriging."""
MAX_RELEVANCE = 4.0


def learn_relevance(lights: Sequence[Light], locations: Array, plain: Array, parts: Array, measured: Array) -> Array:
    """Learn relevances by bounded generalised least squares, which shrinks them towards 1.

    The residuals are differences of spectra and of their colours. Those of entries of close colours are correlated.

    Parameters
    ----------
    lights : sequence of Light
        Lights under which colours should be kept.
    locations : ndarray, shape (n, 3)
        CIE L*a*b* of the entries.
    plain : ndarray, shape (n, N)
        Reflectances expected without families.
    parts : ndarray, shape (F, n, N)
        Contributions of the families to them.
    measured : ndarray, shape (n, N)
        Reflectances of the entries.

    Returns
    -------
    ndarray, shape (F,)
        Relevances, 0 to `MAX_RELEVANCE`; 1 without entries.

    References
    ----------
    Rasmussen & Williams 2006, "Gaussian processes for machine learning", 2.1: the ridge is noise over assumed variance.
    """
    from scipy.optimize import lsq_linear

    assumed = np.ones(len(parts))
    if not len(measured):
        return assumed
    independent = _decorrelate(locations)
    features = _features(lights, np.clip(plain + parts.sum(axis=0), 0, 1))
    columns = np.stack([independent(features(part)).ravel() for part in parts], axis=1)
    unexplained = independent(features(measured - plain))
    noise = noise_variance(unexplained - (columns @ assumed).reshape(unexplained.shape))
    if not columns.any() or not noise:
        return assumed
    ridge = np.sqrt(noise / VARIANCE)
    rows = np.concatenate([columns, ridge * np.eye(len(parts))])
    goal = np.concatenate([unexplained.ravel(), ridge * assumed])
    return np.asarray(lsq_linear(rows, goal, bounds=(0, MAX_RELEVANCE), method="bvls").x)


def noise_variance(residuals: Array) -> float:
    """Estimate the variance of the independent parts of residuals.

    Differences of spectra at neighbouring wavelengths, and of colours, are a few differences many times over. They are
    as many as their covariance has large eigenvalues: (Σ λ)² / Σ λ².

    Parameters
    ----------
    residuals : ndarray, shape (n, K)
        Residuals of n entries.

    Returns
    -------
    float
        Variance; 0 without residuals.
    """
    products = residuals.T @ residuals
    total, squares = np.trace(products), (products**2).sum()
    return float(squares / total / len(residuals)) if total else 0.0


def _decorrelate(locations: Array) -> Callable[[Array], Array]:
    """From residuals (n, K) of entries at L*a*b* (n, 3) to independent ones of unit variance."""
    from scipy.linalg import solve_triangular
    from scipy.spatial.distance import cdist

    covariance = CORRELATED(cdist(locations, locations)) / CORRELATED(np.zeros(()))
    root = np.linalg.cholesky(covariance + JITTER * np.eye(len(covariance)))
    return partial(solve_triangular, root, lower=True)


def _features(lights: Sequence[Light], spectra: Array) -> Callable[[Array], Array]:
    """From changes (n, N) of spectra to their weighted differences (n, N + 3 L) in the objective of entries."""
    matrices = np.stack([light.xyz for light in lights])
    whites = np.stack([light.white for light in lights])
    to_lab = BALANCED.lights * lab_jacobian((spectra @ matrices.mT).swapaxes(0, 1), whites)

    def features(change: Array) -> Array:
        xyz = (change @ matrices.mT).swapaxes(0, 1)
        colours = (to_lab @ xyz[..., None])[..., 0].reshape(len(change), -1)
        return np.concatenate([change / np.sqrt(change.shape[1]), colours], axis=1)

    return features
