"""Kriging of deviations against dense linear algebra."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from uplift.fit import kriging
from uplift.fit.kriging import (
    CELLS,
    MAX_POINTS,
    METRIC,
    NEARBY,
    WHITE,
    Kernel,
    average_close,
    krige,
)

RNG = np.random.default_rng(5)
PLACES = RNG.uniform(-20, 60, (30, 3))
DEVIATIONS = RNG.normal(size=(30, 4))
VARIANCES = RNG.uniform(0.3, 3, 30)
KERNEL = Kernel(length=10.0, noise=0.5, reach=9.0)


def faded(relative):
    """Wendland's function."""
    return np.where(relative < 1, (1 - relative) ** 4 * (1 + 4 * relative), 0)


def covariance(first, second, variances=1.0, kernel=KERNEL):
    """Covariance of materials at L*a*b*, the white noise of a material left out."""
    apart = np.linalg.norm((first[:, None] - second[None]) * METRIC, axis=-1)
    own = faded(apart / kernel.reach)
    return np.exp(-apart / kernel.length) + kernel.noise * (1 - WHITE) * own * variances


def predicted(places, deviations, at, variances, at_variance=1.0):
    """The conditional mean of a Gaussian process at L*a*b* (3)."""
    within = covariance(places, places, np.sqrt(np.outer(variances, variances)))
    within += WHITE * KERNEL.noise * np.diag(variances)
    return covariance(at[None], places, np.sqrt(at_variance * variances))[
        0
    ] @ np.linalg.solve(within, deviations)


@pytest.mark.parametrize("points", [30, 20])
def test_it_is_the_conditional_mean_and_left_out_that_of_the_other_entries(
    monkeypatch, points
):
    """Also where close entries are averaged, which is the same as moving them to their
    mean.
    """
    monkeypatch.setattr(kriging, "MAX_POINTS", points)
    monkeypatch.setattr(kriging, "CELLS", (20.0,))
    means = average_close(PLACES * METRIC, DEVIATIONS)
    assert (len(means.counts) < 30) == (points < 30)
    places = means.locations[means.point] / METRIC
    variances = (np.bincount(means.point, VARIANCES) / means.counts)[means.point]
    found, errors = krige(PLACES, DEVIATIONS, KERNEL, VARIANCES)
    at = np.array([10.0, 20.0, 30.0])
    mean = predicted(places, DEVIATIONS, at, variances)
    assert_allclose(found(at[None])[0], mean, atol=1e-9)
    for row in range(len(PLACES)):
        others = np.arange(len(PLACES)) != row
        again = predicted(
            places[others],
            DEVIATIONS[others],
            places[row],
            variances[others],
            variances[row],
        )
        assert_allclose(DEVIATIONS[row] - errors[row], again, atol=1e-9)


def test_less_trust_expects_less_away_from_entries():
    """All of it at an entry, a share farther than `NEARBY` reaches from the next."""
    full, _ = krige(PLACES, DEVIATIONS, KERNEL, VARIANCES)
    half = replace(full, trust=0.5)
    far = np.array([[0.0, 0, 60 + NEARBY * KERNEL.reach + 1]])
    assert_allclose(half(PLACES), full(PLACES), rtol=1e-9)
    assert_allclose(half(far), full(far) / 2, rtol=1e-9)


def test_close_spectra_are_averaged_where_there_are_many():
    places = RNG.uniform(0, 60, (20 * MAX_POINTS, 3))
    deviations = RNG.normal(size=(20 * MAX_POINTS, 4))
    many = average_close(places, deviations)
    assert len(many.locations) <= MAX_POINTS
    assert_array_equal(many.counts, np.bincount(many.point))
    assert_allclose(many.counts @ many.deviations, deviations.sum(axis=0), atol=1e-9)
    assert np.abs(many.locations[many.point] - places).max() <= CELLS[-1]
