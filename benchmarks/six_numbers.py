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
from uplift.extras.photographs.photograph import Noise

COMPONENTS = 6
"""Principal components: as many as two photographs have numbers."""


def trained(
    known: Array, targets: Array, matrix: Array, noise: Noise, numbers: Array
) -> Array:
    """Estimate spectra (n, N) from numbers (n, 3 L), by a matrix with the least
    expected squares for the noisy numbers of known spectra (K, N) under sensors
    (3 L, N) and their targets (K, N): chart spectra themselves, or `projected` ones.
    """
    observed = known @ matrix.T
    # E Σ |A (t + n) − s|² = Σ |A t − s|² + tr A (Σ R) Aᵀ
    gram = observed.T @ observed + np.diag(noise.variance(observed).sum(axis=0))
    # Without noise few spectra, or a third light, may leave numbers that depend.
    return numbers @ np.linalg.pinv(gram, hermitian=True) @ (observed.T @ targets)


def projected(known: Array) -> Array:
    """Project spectra (K, N) on their first `COMPONENTS` principal components."""
    _, _, axes = np.linalg.svd(known, full_matrices=False)
    components = axes[:COMPONENTS]
    return known @ components.T @ components


def posterior_mean(
    expected: Array, covariance: Array, matrix: Array, noise: Noise, numbers: Array
) -> Array:
    """Move expected spectra (n, N) to noisy numbers (n, 3 L), for differences of
    spectra that have a covariance (N, N).
    """
    # p + C Mᵀ (M C Mᵀ + R)⁻¹ (t − M p)
    to_spectra = covariance @ matrix.T
    gram = np.tile(matrix @ to_spectra, (len(numbers), 1, 1))
    diagonal = np.arange(len(matrix))
    gram[:, diagonal, diagonal] += noise.variance(numbers)
    residual = numbers - expected @ matrix.T
    weights = np.linalg.solve(gram, residual[..., None])[..., 0]
    return expected + weights @ to_spectra.T
