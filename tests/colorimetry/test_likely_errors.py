"""Expected errors, learnt from left-out entries."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.distance import cdist

from uplift.colorimetry import likely_errors as module
from uplift.colorimetry.likely_errors import (
    COVERAGE,
    LENGTH,
    PRIOR_COUNT,
    expected_error,
    familiar_distance,
    learn_radii,
    nearest_distances,
)
from uplift.extras.looks.lab_errors import mahalanobis

PLACES = np.random.default_rng(5).uniform(-20, 60, (12, 3))


@pytest.mark.parametrize("tail", [3, 8, 50])
def test_errors_of_any_tail_are_covered(tail):
    """Of heavy tails, 95 % lie within more than twice the radius of 68 %."""
    rng = np.random.default_rng(tail)
    places, queried = rng.uniform(0, 300, (2, 1500, 3))
    known, unknown = np.abs(rng.standard_t(tail, (2, 1500)))
    learnt = expected_error(places, known, np.zeros(1500))
    expected = np.sqrt(learnt(queried)[:, 0])
    assert (unknown <= learnt.radii[0] * expected).mean() == pytest.approx(
        0.68, abs=0.04
    )
    assert (unknown <= learnt.radii[1] * expected).mean() == pytest.approx(
        0.95, abs=0.02
    )
    assert (learnt.radii[1] > 2.5 * learnt.radii[0]) == (tail == 3)


def test_errors_are_weighted_sums(monkeypatch):
    """Against plain sums at colours, in blocks, and for each entry without itself."""
    queried = np.random.default_rng(6).uniform(-20, 60, (40, 3))
    learnt = expected_error(PLACES, np.arange(1.0, 13), np.zeros(12))
    squares = learnt.columns[:, 0]

    def plain(weights):
        spread = (weights @ squares + PRIOR_COUNT * squares.mean()) / (
            weights.sum(axis=1) + PRIOR_COUNT
        )
        return (1 - weights.max(axis=1) ** 2), spread

    monkeypatch.setattr(module, "BLOCK_NUMBERS", 50)
    distances = cdist(queried, PLACES)
    assert_allclose(
        learnt(queried)[:, 0],
        np.multiply(*plain(np.exp(-distances / LENGTH))),
        rtol=1e-12,
    )
    assert_allclose(
        nearest_distances(queried, PLACES), distances.min(axis=1), rtol=1e-12
    )
    others = np.exp(-cdist(PLACES, PLACES) / LENGTH)
    np.fill_diagonal(others, 0)
    variance, spread = plain(others)
    assert_allclose(
        learnt.left_out[:, 0], np.maximum(variance, 0.02) * spread, rtol=1e-12
    )


@pytest.mark.parametrize("count", [8, 24])
def test_errors_of_few_entries_are_covered(count):
    """Of normal errors whose variance is that of the other ones, on average over many
    atlases.
    """
    errors = np.random.default_rng(count).normal(size=(2000, count + 1))
    squares = errors**2
    known = squares[:, :-1]
    others = (known.sum(axis=1, keepdims=True) - known) / (count - 1)
    radii = np.array([learn_radii(row, COVERAGE) for row in np.sqrt(known / others)])
    within = (np.sqrt(squares[:, -1] / known.mean(axis=1))[:, None] <= radii).mean(
        axis=0
    )
    assert within[0] == pytest.approx(0.68, abs=0.03)
    assert within[1] == pytest.approx(0.95, abs=0.015)


def test_nearly_all_entries_are_within_the_familiar_distance():
    places = np.random.default_rng(8).uniform(0, 100, (3000, 3))
    apart = cdist(places[:1000], places)
    apart[np.arange(1000), np.arange(1000)] = np.inf
    assert (apart.min(axis=1) <= familiar_distance(places)).mean() == pytest.approx(
        0.95, abs=0.02
    )
    assert familiar_distance(np.array([[0.0, 0, 0], [3, 4, 0]])) == pytest.approx(5)


def test_distances_are_those_of_the_inverse_covariance():
    """Huge but finite along directions without variance."""
    covariance = np.array([[[2.0, 1.0], [1.0, 2.0]], [[4.0, 0.0], [0.0, 0.0]]])
    inside = mahalanobis(covariance, np.array([[1.0, 0.0], [6.0, 0.0]]))
    assert inside == pytest.approx([np.sqrt(2 / 3), 3])
    assert 1e100 < mahalanobis(covariance[1:], np.array([[0.0, 1.0]])) < np.inf
