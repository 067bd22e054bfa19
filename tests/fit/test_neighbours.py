"""Distances to the nearest other point, of few points and of many."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.fit import neighbours
from uplift.fit.neighbours import nearest_other


@pytest.mark.parametrize("order", [2, np.inf])
def test_few_and_many_points_have_the_same_neighbours(monkeypatch, order):
    points = np.random.default_rng(4).uniform(0, 60, (300, 3))
    points[7] = points[200]
    few = nearest_other(points, order)
    monkeypatch.setattr(neighbours, "DENSE", 100)
    assert_allclose(nearest_other(points, order), few, rtol=1e-12)
    assert few[7] == few[200] == 0
