"""Rivals of two photographs: worlds in which they are exact, and noise."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks import six_numbers
from benchmarks.materials import materials
from uplift.colorimetry import observer


@pytest.fixture(scope="module")
def matrix():
    daylight = observer.sensor()
    return np.concatenate([daylight.matrix, observer.sensor(illuminant="A").matrix])


@pytest.fixture(scope="module")
def chart():
    return materials("macbeth").measured


def no_noise(count, matrix):
    return np.zeros((count, len(matrix)))


def test_methods_are_exact_for_mixtures_of_six_spectra(chart, matrix):
    weights = np.random.default_rng(0).dirichlet(np.ones(6), 60)
    spectra = weights @ chart[:6]
    known = spectra[:40]
    queried = spectra[40:]
    variance = no_noise(len(known), matrix)
    numbers = queried @ matrix.T
    by_chart = six_numbers.chart_matrix(known, matrix, variance, numbers)
    assert_allclose(by_chart, queried, atol=1e-4)
    by_scores = six_numbers.principal_components(known, matrix, variance, numbers)
    assert_allclose(by_scores, queried, atol=1e-4)


def test_the_trained_matrix_has_the_least_expected_squares(chart, matrix):
    """Compared with a least-squares fit to many noisy photographs of the chart."""
    random = np.random.default_rng(1)
    numbers = chart @ matrix.T
    scale = 0.02 * numbers + 0.002
    repeated = np.tile(numbers, (4000, 1))
    noisy = repeated + np.tile(scale, (4000, 1)) * random.standard_normal(
        repeated.shape
    )
    targets = np.tile(chart[:, ::20], (4000, 1))
    expected = np.linalg.lstsq(noisy, targets, rcond=None)[0]
    trained = six_numbers.train_matrix(numbers, chart[:, ::20], scale**2)
    assert_allclose(trained, expected, atol=0.02 * np.abs(expected).max())


def test_the_posterior_mean_is_that_of_joint_gaussians(matrix):
    """Conditioning the joint covariance of spectrum and numbers, colour by colour."""
    random = np.random.default_rng(2)
    factor = random.normal(size=(81, 20)) / 30
    covariance = factor @ factor.T
    expected = random.uniform(0.3, 0.6, (5, 81))
    numbers = expected @ matrix.T + random.normal(0, 0.01, (5, 6))
    variance = random.uniform(1e-5, 1e-4, (5, 6))
    moved = six_numbers.posterior_mean(expected, covariance, matrix, variance, numbers)
    joint = np.concatenate([np.eye(81), matrix])
    for row in range(5):
        noise = np.diag(np.append(np.zeros(81), variance[row]))
        of_both = joint @ covariance @ joint.T + noise
        gain = of_both[:81, 81:] @ np.linalg.inv(of_both[81:, 81:])
        change = gain @ (numbers[row] - matrix @ expected[row])
        assert_allclose(moved[row], expected[row] + change, atol=1e-10)
