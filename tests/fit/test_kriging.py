"""Kriging of deviations against dense linear algebra, and standard errors."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.fit.kriging import LENGTH, NUGGET, krige, uncertainty

RNG = np.random.default_rng(5)
PLACES = RNG.uniform(-20, 60, (12, 3))
DEVIATIONS = RNG.normal(size=(12, 4))


def kernel(first, second):
    return np.exp(-np.linalg.norm(first[:, None] - second[None], axis=-1) / LENGTH)


def test_deviation_is_that_of_the_entry_at_its_colour_and_vanishes_far_away():
    found, _ = krige(PLACES, DEVIATIONS)
    np.testing.assert_allclose(found(PLACES), DEVIATIONS, atol=5 * NUGGET)
    assert np.abs(found(PLACES[:1] + 1000)).max() < 1e-12


def test_leave_one_out_equals_kriging_of_the_other_entries():
    _, without = krige(PLACES, DEVIATIONS)
    for row in range(len(PLACES)):
        others = np.arange(len(PLACES)) != row
        again, _ = krige(PLACES[others], DEVIATIONS[others])
        np.testing.assert_allclose(without[row], again(PLACES[row : row + 1])[0], atol=1e-9)


def test_two_entries_agree_with_the_closed_form():
    found, _ = krige(PLACES, DEVIATIONS)
    queried = RNG.uniform(-20, 60, (5, 3))
    weights = np.linalg.solve(kernel(PLACES, PLACES) + NUGGET * np.eye(12), DEVIATIONS)
    np.testing.assert_allclose(found(queried), kernel(queried, PLACES) @ weights, atol=1e-9)


def test_different_spectra_of_one_colour_are_averaged():
    found, _ = krige(np.zeros((2, 3)), np.array([[1.0], [3.0]]))
    assert found(np.zeros((1, 3)))[0, 0] == pytest.approx(2, abs=0.01)


def test_the_standard_error_grows_with_the_distance_to_the_entries():
    learnt = uncertainty(PLACES, np.full(12, 2.0), np.full(12, 0.1))
    away = PLACES[:1] + np.array([[0.0], [1.0], [5.0], [20.0], [1000.0]]) * [[0, 0, -1]]
    errors = learnt(away)
    assert errors[0] == pytest.approx(0.1)
    assert (np.diff(errors) > 0).all()
    assert errors[-1] > 2


def test_errors_are_local():
    """The error is larger where left-out entries were predicted badly."""
    places = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [80, 0, 0], [83, 0, 0], [80, 3, 0]])
    learnt = uncertainty(places, np.array([3.0, 3, 3, 0.3, 0.3, 0.3]), np.zeros(6))
    hard, easy = learnt(np.array([[0.0, 0, 2], [80, 0, 2]]))
    assert hard > 1.5 * easy


def test_results_do_not_depend_on_the_size_of_blocks(monkeypatch):
    found, _ = krige(PLACES, DEVIATIONS)
    queried = RNG.uniform(-20, 60, (50, 3))
    whole = found(queried)
    monkeypatch.setattr("uplift.fit.kriging.BLOCK_NUMBERS", 25)
    np.testing.assert_allclose(found(queried), whole, rtol=1e-12, atol=1e-15)
