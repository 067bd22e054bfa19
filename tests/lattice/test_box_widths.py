"""Widths of entry boxes: no overlap, and no box for a colour that an earlier entry has."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.fit.seeds import MAX_HALF_WIDTH, half_widths
from uplift.lattice import Lattice

LATTICE = Lattice(np.linspace(0, 1, 9) ** 2)
colours = arrays(float, st.tuples(st.integers(0, 12), st.just(3)), elements=st.floats(0, 1))


@given(colours)
def test_no_two_boxes_overlap(rgb):
    reaches, steps = half_widths(LATTICE, rgb), LATTICE.to_steps(rgb)
    assert ((reaches >= 0) & (reaches <= MAX_HALF_WIDTH)).all()
    for first in range(len(rgb)):
        for second in range(first):
            if reaches[first] and reaches[second]:
                apart = np.abs(steps[first] - steps[second]).max()
                assert reaches[first] + reaches[second] <= apart + 1e-12


def test_only_the_first_entry_of_a_colour_has_a_box():
    rgb = np.array([[0.2, 0.2, 0.2], [0.2, 0.2, 0.2], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2]])
    assert half_widths(LATTICE, rgb).tolist() == [MAX_HALF_WIDTH, 0, MAX_HALF_WIDTH, 0]


def test_a_single_entry_has_the_largest_box():
    assert half_widths(LATTICE, np.array([[0.3, 0.4, 0.5]])).tolist() == [MAX_HALF_WIDTH]
