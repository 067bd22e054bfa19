"""Rivals of two photographs: worlds in which they are exact, and noise."""

import numpy as np
from numpy.testing import assert_allclose

from benchmarks import six_numbers
from uplift.colorimetry import observer
from uplift.extras.photographs.photograph import Noise

MATRIX = np.concatenate(
    [observer.sensor(illuminant=name).matrix for name in ("D65", "A")]
)


def test_the_posterior_mean_is_that_of_joint_gaussians():
    """Conditioning the joint covariance of a spectrum and its numbers."""
    random = np.random.default_rng(2)
    factor = random.normal(size=(81, 20)) / 30
    covariance = factor @ factor.T
    expected = random.uniform(0.3, 0.6, (1, 81))
    noise = Noise(0.01, 0.003)
    numbers = expected @ MATRIX.T + random.normal(0, 0.01, (1, 6))
    moved = six_numbers.posterior_mean(expected, covariance, MATRIX, noise, numbers)
    to_spectra = covariance @ MATRIX.T
    of_numbers = MATRIX @ to_spectra + np.diag(noise.variance(numbers[0]))
    gain = to_spectra @ np.linalg.inv(of_numbers)
    change = (numbers - expected @ MATRIX.T) @ gain.T
    assert_allclose(moved, expected + change, atol=1e-10)
