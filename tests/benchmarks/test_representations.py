"""What docs/representations.md is made of."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.representations import introduction, thesis
from benchmarks.representations.closed import closed, enhanced
from uplift.scene.representations.dense import xyz_weights


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


def test_the_thesis_is_read_as_it_is_printed():
    assert thesis.tables()["spiky", "CS15"] == thesis.Printed(0.316, 0.222, 0.816)
    assert thesis.filters()["spiky", 16, "mitchell"].parameters == "extent 19, b -0.4, c 1"


def test_numbers_in_the_text_do_not_spoil_its_lines():
    paragraphs = introduction.TEXT.split("\n\n")
    for paragraph in paragraphs:
        wrapped = introduction._wrapped(paragraph)
        assert wrapped.split() == paragraph.split()
        assert max(map(len, wrapped.splitlines())) <= introduction.WIDTH
