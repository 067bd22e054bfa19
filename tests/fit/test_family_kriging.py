"""Kriging of families, against the conditional mean of the explicit joint covariance."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.fit.family_kriging import (
    LENGTH,
    MAX_POINTS,
    NUGGET,
    FamilySamples,
    average_close,
    krige_families,
)

RNG = np.random.default_rng(5)


def samples(count, spread=5.0, related=0.0, counts=1.0):
    locations = RNG.uniform([20, -30, -30], [90, 30, 30], (count, 3))
    return FamilySamples(locations, RNG.normal(size=(count, 4)), np.full(count, counts), spread, related)


def matern(first, second):
    scaled = np.sqrt(3) * np.linalg.norm(first[:, None] - second[None], axis=-1) / LENGTH
    return (1 + scaled) * np.exp(-scaled)


def conditional_mean(families, lab):
    """Mean of shared deviation plus the related share of each family's own, given all samples."""
    where = np.concatenate([family.locations for family in families])
    what = np.concatenate([family.deviations for family in families])
    covariance = matern(where, where)
    cross = matern(lab, where)
    first = 0
    for family in families:
        own = slice(first, first + len(family.locations))
        covariance[own, own] += family.spread * matern(family.locations, family.locations)
        covariance[own, own] += np.diag(NUGGET / family.counts)
        cross[:, own] *= 1 + family.related * family.spread
        first = own.stop
    return cross @ np.linalg.solve(covariance, what)


@pytest.mark.parametrize("sizes", [(12, 30), (1, 7, 0), (25,)])
def test_it_is_the_conditional_mean(sizes):
    families = [
        samples(size, spread, related) for size, spread, related in zip(sizes, (5, 1, 2), (0, 0.5, 1), strict=False)
    ]
    lab = RNG.uniform([0, -60, -60], [100, 60, 60], (50, 3))
    kriging = krige_families(families)
    np.testing.assert_allclose(kriging(lab, np.ones(len(sizes))), conditional_mean(families, lab), atol=1e-9)


def test_the_sum_of_the_contributions_times_relevance_is_the_answer():
    kriging = krige_families([samples(9), samples(14), samples(0)])
    lab = RNG.uniform(0, 80, (6, 3))
    relevance = np.array([0.3, 2.0, 1.0])
    expected = np.einsum("f,fnk->nk", relevance, kriging.contributions(lab))
    np.testing.assert_allclose(kriging(lab, relevance), expected, atol=1e-12)


def test_a_large_family_does_not_outweigh_a_small_one():
    place = np.array([[50.0, 0, 0]])
    small = FamilySamples(place.repeat(3, axis=0), np.full((3, 1), -1.0), np.ones(3), 5.0, 0.0)
    large = FamilySamples(place.repeat(300, axis=0), np.full((300, 1), 1.0), np.ones(300), 5.0, 0.0)
    both = krige_families([small, large])(place, np.ones(2))
    assert abs(both.item()) < 0.01
    same_family = FamilySamples(
        np.concatenate([small.locations, large.locations]),
        np.concatenate([small.deviations, large.deviations]),
        np.ones(303),
        5.0,
        0.0,
    )
    assert krige_families([same_family])(place, np.ones(1)).item() > 0.1


def test_close_spectra_are_averaged_where_there_are_many():
    few = samples(20)
    locations, deviations, counts = average_close(few.locations, few.deviations)
    assert locations is few.locations
    assert deviations is few.deviations
    np.testing.assert_array_equal(counts, 1)
    many = samples(20 * MAX_POINTS)
    locations, deviations, counts = average_close(many.locations, many.deviations)
    assert len(locations) <= MAX_POINTS
    assert counts.sum() == len(many.locations)
    np.testing.assert_allclose(counts @ deviations, many.deviations.sum(axis=0), atol=1e-9)
