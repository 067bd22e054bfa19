"""Discs of lamps: those that contain a chromaticity, as a comparison with every disc finds them."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.lights.discs import LampEntries


def entries(uv, radius):
    return LampEntries(tuple(map(str, range(len(uv)))), uv, np.ones((len(uv), 3)), radius)


@pytest.fixture(scope="module")
def lamps():
    """Discs in and across bins: a row of small ones, which share a bin, a large one, and one at the edge."""
    uv = np.array([[0.2 + 4e-4 * step, 0.5] for step in range(9)] + [[0.4, 0.3], [0.0, 0.4]])
    return entries(uv, np.array([2e-4] * 9 + [0.05, 0.01]))


def test_discs_are_those_of_a_comparison_with_all(lamps):
    rng = np.random.default_rng(0)
    near = lamps.uv[rng.integers(0, 11, 3000)]
    uv = near + rng.normal(size=(3000, 2)) * lamps.radius[rng.integers(0, 11, 3000), None]
    hits = lamps.locate(uv)
    distance = np.linalg.norm(uv[:, None] - lamps.uv, axis=-1)
    rows, entry = np.nonzero(distance < lamps.radius)
    assert 500 < len(rows) < 2500
    np.testing.assert_array_equal(hits.rows, rows)
    np.testing.assert_array_equal(hits.entry, entry)
    np.testing.assert_allclose(hits.share, 1 - distance[rows, entry] / lamps.radius[entry], atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(hits.exit_uv - lamps.uv[entry], axis=1), lamps.radius[entry])


def test_a_lamp_has_all_of_its_own_chromaticity(lamps):
    hits = lamps.locate(lamps.uv)
    np.testing.assert_array_equal(hits.entry, np.arange(11))
    np.testing.assert_array_equal(hits.share, 1)


def test_chromaticities_far_away_are_in_no_disc(lamps):
    assert not lamps.locate(np.array([[-10.0, 10.0], [10.0, -10.0], [0.9, 0.9]])).rows.size


def test_no_lamps_have_no_discs():
    assert not entries(np.empty((0, 2)), np.empty(0)).locate(np.full((4, 2), 0.3)).rows.size
