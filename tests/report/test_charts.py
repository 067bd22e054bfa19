"""Histograms and their bins; charts are XML."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.report.charts import linear_edges, log_edges, make_histogram


def test_histogram_counts_every_value():
    values = np.array([0.0, 1e-12, 3e-7, 0.2, 0.2, 5.0])
    for edges in (log_edges(values, 1e-9), linear_edges(values)):
        found = make_histogram(values, edges)
        assert found.counts.sum() == 6
        assert (np.diff(edges) > 0).all()
        assert (found.mean, found.largest) == (values.mean(), 5.0)
        assert edges[-1] >= 5
    assert make_histogram(values, log_edges(values, 1e-9)).logarithmic
    assert not make_histogram(values, linear_edges(values)).logarithmic


@pytest.mark.parametrize("value", [0.0, 1e-15, 1.0, 0.024, 24.0, 777.0])
def test_edges_contain_any_value(value):
    for edges in (log_edges([value], 1e-9), linear_edges([value])):
        assert len(edges) >= 2
        assert (np.diff(edges) > 0).all()
        assert edges[-1] >= value * (1 - 1e-9)
