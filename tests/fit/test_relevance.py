"""Relevances of families: found where families explain an atlas, and near 1 where they do not."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.fit.relevance import MAX_RELEVANCE, learn_relevance, noise_variance

LIGHTS = [observer.light(name) for name in ("A", "FL11")]
RNG = np.random.default_rng(5)
ENTRIES = 40
PLACES = RNG.uniform((0, -50, -50), (100, 50, 50), (ENTRIES, 3))
PLAIN = np.full((ENTRIES, 81), 0.4)
WAVES = np.cos(np.arange(2, 8)[:, None] * np.linspace(0, np.pi, 81))
PARTS = 0.02 * RNG.normal(size=(2, ENTRIES, 6)) @ WAVES
OTHERS = RNG.normal(size=(20, ENTRIES, 6)) @ WAVES
"""Deviations of entries that no family explains."""


def learn(measured, rows=slice(None)):
    return learn_relevance(LIGHTS, PLACES[rows], PLAIN[rows], PARTS[:, rows], measured[rows])


@pytest.mark.parametrize("truth", [(2.0, 0.5), (0.0, 1.0), (1.3, 1.6)])
def test_relevances_of_an_explained_atlas_are_found(truth):
    measured = PLAIN + np.tensordot(truth, PARTS, 1)
    np.testing.assert_allclose(learn(measured + 1e-4 * OTHERS[0]), truth, atol=0.1)


def test_relevances_have_bounds():
    assert learn(PLAIN + 7 * PARTS[0] + PARTS[1])[0] == MAX_RELEVANCE
    assert learn(PLAIN + PARTS[0] - 5 * PARTS[1])[1] == 0


def distances(amplitude, rows=slice(None)):
    """Distance from 1 of relevances that are truly 2 and 0, over atlases."""
    measured = PLAIN + 2 * PARTS[0]
    return np.mean([np.abs(learn(measured + amplitude * other, rows) - 1).mean() for other in OTHERS])


def test_what_no_family_explains_keeps_relevances_near_1():
    assert distances(0.001) > 0.9
    assert distances(0.5) < 0.5
    assert distances(0.05, slice(0, 3)) < distances(0.05) - 0.1


def test_without_entries_or_differences_relevances_are_1():
    exact = PLAIN + PARTS.sum(axis=0)
    unused = learn_relevance(LIGHTS, PLACES, PLAIN, 0 * PARTS, exact)
    for learnt in (learn(PLAIN, slice(0, 0)), learn(exact), unused):
        np.testing.assert_allclose(learnt, 1, atol=1e-12)


@pytest.mark.parametrize("parts", [1, 3])
def test_noise_counts_independent_parts(parts):
    """Residuals of 40 values are combinations of a few independent ones of variance 4."""
    directions = np.linalg.qr(RNG.normal(size=(40, parts)))[0].T
    residuals = 2 * RNG.normal(size=(4000, parts)) @ directions
    assert noise_variance(residuals) == pytest.approx(4, rel=0.1)
    assert noise_variance(0 * residuals) == 0
