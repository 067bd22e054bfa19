"""Entries as extra nodes, against the plain definition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.cube.pins import Pins
from uplift.fit.reach import reach
from uplift.lattice import Lattice

LATTICE = Lattice(np.linspace(0, 1, 7) ** 2)
unit = st.floats(0, 1)
colours = arrays(float, st.tuples(st.integers(0, 10), st.just(3)), elements=unit, unique=True)
asked = arrays(float, st.tuples(st.integers(1, 30), st.just(3)), elements=unit)


def pins(rgb):
    return Pins(LATTICE, rgb, reach(LATTICE, rgb))


@given(colours, asked)
def test_the_mixture_is_the_colour(entries, rgb):
    found = pins(entries)
    away, entry, share = found(rgb)
    assert ((share >= 0) & (share <= 1)).all()
    assert ((away >= 0) & (away <= 1)).all()
    mixed = share[:, None] * away
    rows = entry >= 0
    mixed[rows] += (1 - share[rows, None]) * entries[entry[rows]]
    np.testing.assert_allclose(mixed, rgb, atol=1e-12)
    assert (share[~rows] == 1).all()


@given(colours, asked)
def test_boxes_are_found_as_by_looking_at_each(entries, rgb):
    found = pins(entries)
    _, entry, share = found(rgb)
    steps, middles = LATTICE.steps_along(rgb), LATTICE.steps_along(entries)
    for row in range(len(rgb)):
        apart = np.abs(steps[row] - middles).max(axis=1) if len(entries) else np.zeros(0)
        inside = np.flatnonzero((apart < found.reach - 1e-9) & (found.reach > 0))
        if inside.size:
            assert entry[row] == inside[0]
        elif entry[row] >= 0:
            assert share[row] == pytest.approx(1, abs=1e-6)


def test_at_an_entry_the_lattice_has_no_share():
    entries = np.array([[0.2, 0.3, 0.4], [0.0, 1.0, 0.5]])
    _, entry, share = pins(entries)(entries)
    assert entry.tolist() == [0, 1]
    assert share.tolist() == [0, 0]


def test_on_the_face_of_a_box_the_lattice_has_all():
    found = pins(np.array([[0.2, 0.3, 0.4]]))
    low, high = found.faces
    asked, _, share = found(np.array([[low[0, 0], 0.3, 0.4], [0.2, high[0, 1], 0.41]]))
    np.testing.assert_allclose(share, 1)
    np.testing.assert_allclose(asked[0], [low[0, 0], 0.3, 0.4])


def test_no_entries_no_pins():
    away, entry, share = pins(np.zeros((0, 3)))(np.full((2, 3), 0.5))
    assert (entry == -1).all()
    assert (share == 1).all()
    assert (away == 0.5).all()
