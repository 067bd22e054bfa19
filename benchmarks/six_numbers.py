"""Methods that estimate spectra from the linear RGB of several photographs, the rivals
of `uplift.extras.photographs`.

All are linear in the numbers t of the photographs, three of each, with the sensors M:

- a matrix trained on a chart of K patches that is in the pictures, as in the program
  Beyond RGB (Kuzio & Farnand 2022, Heritage 5(4), 4140-4160,
  doi 10.3390/heritage5040214);
- principal components of training spectra, whose scores are a linear function of t
  (Imai & Berns 1999, "Spectral estimation using trichromatic digital cameras", Proc.
  International Symposium on Multispectral Imaging and Color Reproduction for Digital
  Archives);
- the posterior mean of Gaussian residuals around an expected spectrum, without bounds.
"""

import numpy as np

from uplift.common.arrays import Array

COMPONENTS = 6
"""Principal components: as many as two photographs have numbers."""


def train_matrix(numbers: Array, targets: Array, variance: Array) -> Array:
    """Matrix (3 L, K) from numbers to targets, the least expected squares for training
    pairs (n, 3 L), (n, K) whose numbers have noise of some variance (n, 3 L).
    """
    # E Σ |A (t + n) − s|² = Σ |A t − s|² + tr A (Σ R) Aᵀ
    gram = numbers.T @ numbers + np.diag(variance.sum(axis=0))
    # Without noise few spectra, or a third light, may leave numbers that depend.
    return np.linalg.pinv(gram, hermitian=True) @ (numbers.T @ targets)


def chart_matrix(chart: Array, matrix: Array, variance: Array, numbers: Array) -> Array:
    """Estimate spectra (n, N) from numbers (n, 3 L), by a matrix trained on the spectra
    (K, N) of a chart under sensors (3 L, N).
    """
    return numbers @ train_matrix(chart @ matrix.T, chart, variance)


def principal_components(
    known: Array, matrix: Array, variance: Array, numbers: Array
) -> Array:
    """Estimate spectra (n, N) from numbers (n, 3 L), by `COMPONENTS` principal
    components of known spectra (K, N), whose scores are linear in the numbers.
    """
    _, _, axes = np.linalg.svd(known, full_matrices=False)
    components = axes[:COMPONENTS]
    scores = known @ components.T
    return numbers @ train_matrix(known @ matrix.T, scores, variance) @ components


def posterior_mean(
    expected: Array, covariance: Array, matrix: Array, variance: Array, numbers: Array
) -> Array:
    """Move expected spectra (n, N) to numbers (n, 3 L) with a variance (n, 3 L), for
    differences of spectra that have a covariance (N, N).
    """
    # p + C Mᵀ (M C Mᵀ + R)⁻¹ (t − M p)
    to_spectra = covariance @ matrix.T
    gram = np.tile(matrix @ to_spectra, (len(numbers), 1, 1))
    diagonal = np.arange(len(matrix))
    gram[:, diagonal, diagonal] += variance
    residual = numbers - expected @ matrix.T
    weights = np.linalg.solve(gram, residual[..., None])[..., 0]
    return expected + weights @ to_spectra.T
