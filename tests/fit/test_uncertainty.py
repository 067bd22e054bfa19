"""Standard errors of left-out entries."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.fit.uncertainty import uncertainty

PLACES = np.random.default_rng(5).uniform(-20, 60, (12, 3))


def test_the_standard_error_grows_with_the_distance_to_the_entries():
    learnt = uncertainty(PLACES, np.full(12, 2.0), np.full(12, 0.1))
    away = PLACES[:1] + np.array([[0.0], [1.0], [5.0], [20.0], [1000.0]]) * [[0, 0, -1]]
    errors = learnt(away)
    assert errors[0] == pytest.approx(0.1)
    assert (np.diff(errors) > 0).all()
    assert errors[-1] > 1.5


@pytest.mark.parametrize("tail", [3, 8, 50])
def test_errors_of_any_tail_are_covered(tail):
    """Without the correction, the standard error of heavy tails is too large for most entries."""
    rng = np.random.default_rng(tail)
    places, queried = rng.uniform(0, 300, (2, 1500, 3))
    known, unknown = np.abs(rng.standard_t(tail, (2, 1500)))
    expected = uncertainty(places, known, np.zeros(1500))(queried)
    assert 0.62 < (unknown <= expected).mean() < 0.78
    assert 0.91 < (unknown <= 2 * expected).mean() < 0.98


def test_errors_are_local():
    """The error is larger where left-out entries were predicted badly."""
    places = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [80, 0, 0], [83, 0, 0], [80, 3, 0]])
    learnt = uncertainty(places, np.array([3.0, 3, 3, 0.3, 0.3, 0.3]), np.zeros(6))
    hard, easy = learnt(np.array([[0.0, 0, 2], [80, 0, 2]]))
    assert hard > 1.5 * easy
