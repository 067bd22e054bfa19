"""Rivals of two photographs: worlds in which they are exact, and noise."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks import six_numbers
from benchmarks.materials import materials
from uplift.colorimetry import observer
from uplift.extras.photographs import Noise


@pytest.fixture(scope="module")
def matrix():
    daylight = observer.sensor()
    return np.concatenate([daylight.matrix, observer.sensor(illuminant="A").matrix])


@pytest.fixture(scope="module")
def chart():
    return materials("macbeth").measured


def test_methods_are_exact_for_mixtures_of_six_spectra(chart, matrix):
    weights = np.random.default_rng(0).dirichlet(np.ones(6), 60)
    known, queried = np.split(weights @ chart[:6], [40])
    for targets in (known, six_numbers.projected(known)):
        found = six_numbers.trained(known, targets, matrix, Noise(), queried @ matrix.T)
        assert_allclose(found, queried, atol=1e-4)


def test_the_trained_matrix_has_the_least_expected_squares(chart, matrix):
    """Compared with a least-squares fit to many noisy photographs of the chart."""
    random = np.random.default_rng(1)
    noise = Noise(0.02, 0.002)
    repeated = np.tile(chart @ matrix.T, (4000, 1))
    scale = np.sqrt(noise.variance(repeated))
    noisy = repeated + scale * random.standard_normal(repeated.shape)
    targets = np.tile(chart[:, ::20], (4000, 1))
    expected = np.linalg.lstsq(noisy, targets, rcond=None)[0]
    found = six_numbers.trained(chart, chart[:, ::20], matrix, noise, np.eye(6))
    assert_allclose(found, expected, atol=0.02 * np.abs(expected).max())


def test_the_posterior_mean_is_that_of_joint_gaussians(matrix):
    """Conditioning the joint covariance of a spectrum and its numbers."""
    random = np.random.default_rng(2)
    factor = random.normal(size=(81, 20)) / 30
    covariance = factor @ factor.T
    expected = random.uniform(0.3, 0.6, (1, 81))
    noise = Noise(0.01, 0.003)
    numbers = expected @ matrix.T + random.normal(0, 0.01, (1, 6))
    moved = six_numbers.posterior_mean(expected, covariance, matrix, noise, numbers)
    to_spectra = covariance @ matrix.T
    of_numbers = matrix @ to_spectra + np.diag(noise.variance(numbers[0]))
    gain = to_spectra @ np.linalg.inv(of_numbers)
    change = (numbers - expected @ matrix.T) @ gain.T
    assert_allclose(moved, expected + change, atol=1e-10)
