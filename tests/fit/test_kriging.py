"""Kriging of deviations against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uplift.fit.kriging import JITTER, REACH, Kernel, krige

RNG = np.random.default_rng(5)
PLACES = RNG.uniform(-20, 60, (12, 3))
DEVIATIONS = RNG.normal(size=(12, 4))
KERNEL = Kernel(length=10.0, nugget=0.5)


def covariance(first, second):
    apart = np.linalg.norm(first[:, None] - second[None], axis=-1)
    own = np.where(apart < REACH, (1 - apart / REACH) ** 4 * (1 + 4 * apart / REACH), 0)
    return np.exp(-apart / 10) + 0.5 * own


def test_deviation_is_that_of_the_entry_at_its_colour_and_vanishes_far_away():
    found, _ = krige(PLACES, DEVIATIONS, KERNEL)
    np.testing.assert_allclose(found(PLACES), DEVIATIONS, atol=5 * JITTER)
    assert np.abs(found(PLACES[:1] + 1000)).max() < 1e-12


def test_leave_one_out_equals_kriging_of_the_other_entries():
    _, errors = krige(PLACES, DEVIATIONS, KERNEL)
    for row in range(len(PLACES)):
        others = np.arange(len(PLACES)) != row
        again, _ = krige(PLACES[others], DEVIATIONS[others], KERNEL)
        np.testing.assert_allclose(DEVIATIONS[row] - errors[row], again(PLACES[row : row + 1])[0], atol=1e-9)


def test_deviations_agree_with_the_closed_form():
    found, _ = krige(PLACES, DEVIATIONS, KERNEL)
    queried = RNG.uniform(-20, 60, (5, 3))
    weights = np.linalg.solve(covariance(PLACES, PLACES) + JITTER * np.eye(12), DEVIATIONS)
    np.testing.assert_allclose(found(queried), covariance(queried, PLACES) @ weights, atol=1e-9)


def test_different_spectra_of_one_colour_are_averaged():
    found, _ = krige(np.zeros((2, 3)), np.array([[1.0], [3.0]]), KERNEL)
    assert found(np.zeros((1, 3)))[0, 0] == pytest.approx(2, abs=0.01)


def test_a_nugget_limits_the_deviation_of_one_entry_to_its_neighbourhood():
    places = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]])
    deviations = np.array([[1.0], [0], [0]])
    near, far = np.array([[0.0, 0, 1]]), np.array([[0.0, 0, 20]])
    shared, own = (krige(places, deviations, Kernel(10.0, nugget))[0] for nugget in (0.01, 2.0))
    assert own(near)[0, 0] > 0.8
    assert abs(own(far)[0, 0]) < 0.3 * own(near)[0, 0]
    assert own(places)[0, 0] == pytest.approx(shared(places)[0, 0], abs=0.01)


@given(st.floats(3, 60), st.floats(0, 4), st.integers(0, 1000))
def test_kernels_are_positive_definite(length, nugget, seed):
    places = np.random.default_rng(seed).uniform(0, 30, (30, 3))
    apart = np.linalg.norm(places[:, None] - places[None], axis=-1)
    assert np.linalg.eigvalsh(Kernel(length, nugget)(apart)).min() > 0


def test_results_do_not_depend_on_the_size_of_blocks(monkeypatch):
    found, _ = krige(PLACES, DEVIATIONS, KERNEL)
    queried = RNG.uniform(-20, 60, (50, 3))
    whole = found(queried)
    monkeypatch.setattr("uplift.fit.kriging.BLOCK_NUMBERS", 25)
    np.testing.assert_allclose(found(queried), whole, rtol=1e-12, atol=1e-15)
