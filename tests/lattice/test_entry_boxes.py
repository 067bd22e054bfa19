"""Entries as extra nodes, against the plain definition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.lattice import Lattice
from uplift.lattice.box_widths import half_widths
from uplift.lattice.entry_boxes import EntryBoxes

LATTICE = Lattice(np.linspace(0, 1, 7) ** 2)
unit = st.floats(0, 1)
colours = arrays(float, st.tuples(st.integers(0, 10), st.just(3)), elements=unit, unique=True)
asked = arrays(float, st.tuples(st.integers(1, 30), st.just(3)), elements=unit)


def pins(rgb):
    return EntryBoxes(LATTICE, rgb, half_widths(LATTICE, rgb))


@given(colours, asked)
def test_the_mixture_is_the_colour(entries, rgb):
    rows, entry, share, away = pins(entries)(rgb)
    assert ((share >= 0) & (share <= 1)).all()
    assert ((away >= 0) & (away <= 1)).all()
    mixed = share[:, None] * away + (1 - share[:, None]) * entries[entry]
    np.testing.assert_allclose(mixed, rgb[rows], atol=1e-12)


@given(colours, asked)
def test_boxes_are_found_as_by_looking_at_each(entries, rgb):
    found = pins(entries)
    pinned = found(rgb)
    held = dict(zip(pinned.rows, zip(pinned.entry, pinned.share, strict=True), strict=True))
    steps, middles = LATTICE.steps_along(rgb), LATTICE.steps_along(entries)
    for row in range(len(rgb)):
        apart = np.abs(steps[row] - middles).max(axis=1) if len(entries) else np.zeros(0)
        inside = np.flatnonzero((apart < found.reach - 1e-9) & (found.reach > 0))
        if inside.size:
            assert held[row][0] == inside[0]
        elif row in held:
            assert held[row][1] == pytest.approx(1, abs=1e-6)


def test_at_an_entry_the_lattice_has_no_share():
    entries = np.array([[0.2, 0.3, 0.4], [0.0, 1.0, 0.5]])
    rows, entry, share, _ = pins(entries)(entries)
    assert rows.tolist() == [0, 1]
    assert entry.tolist() == [0, 1]
    assert share.tolist() == [0, 0]


def test_on_the_face_of_a_box_the_lattice_has_all():
    found = pins(np.array([[0.2, 0.3, 0.4]]))
    low, high = found.faces
    _, _, share, away = found(np.array([[low[0, 0], 0.3, 0.4], [0.2, high[0, 1], 0.41]]))
    np.testing.assert_allclose(share, 1)
    np.testing.assert_allclose(away[0], [low[0, 0], 0.3, 0.4])


def test_no_entries_no_pins():
    assert not pins(np.zeros((0, 3)))(np.full((2, 3), 0.5)).rows.size


def test_cells_that_no_box_touches_are_known():
    found = pins(np.array([[0.2, 0.3, 0.4]]))
    rgb = np.random.default_rng(0).random((500, 3))
    cells = LATTICE.index(LATTICE.cell(rgb)[0])
    np.testing.assert_array_equal(found.touched[cells], np.isin(cells, found.cells[0]))
    assert found.touched.sum() == len(found.cells[0]) == 27
