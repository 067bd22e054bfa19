"""Closed Riemann sums, and the printed tables of the thesis."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.representations import thesis
from benchmarks.representations.closed import closed, enhanced
from uplift.scene.representations.samples import xyz_weights


@pytest.mark.parametrize("count", [8, 16, 32])
def test_closed_cells_keep_the_white(count):
    light = np.ones((1, 401))
    for one in (closed(count), enhanced(count)):
        np.testing.assert_allclose(one.xyz(one.encode_light(light)), light @ xyz_weights(), rtol=2e-3)


def test_a_sample_on_a_border_counts_twice():
    line = np.zeros((1, 401))
    line[0, 25] = 1  # 405 nm: a border of 16 cells, and within one of 15
    assert (closed(16).encode_light(line) > 0).sum() == 2
    assert (closed(15).encode_light(line) > 0).sum() == 1


def test_thesis_tables_have_the_printed_values():
    assert thesis.tables()["spiky", "CS15"] == thesis.Printed(0.316, 0.222, 0.816)
    assert thesis.filters()["spiky", 16, "mitchell"].parameters == "extent 19, b -0.4, c 1"
