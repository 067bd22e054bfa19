"""Entry boxes against their definition."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from tests.cube.hand_made import table
from uplift.fit.seeds import MAX_HALF_WIDTH, half_widths, outside_half_widths
from uplift.lattice.entry_boxes import MARGIN, EntryBoxes, OutsideBoxes
from uplift.lattice.lattice import Lattice
from uplift.lookup.interpolate import around

LATTICE = Lattice(np.linspace(0, 1, 7) ** 2)
unit = st.floats(0, 1)
colours = arrays(
    float, st.tuples(st.integers(0, 10), st.just(3)), elements=unit, unique=True
)
queried = arrays(float, st.tuples(st.integers(1, 30), st.just(3)), elements=unit)


def boxes(rgb):
    return EntryBoxes(LATTICE, rgb, half_widths(LATTICE.to_steps(rgb)))


@given(colours, queried)
def test_the_mixture_has_the_colour(entries, rgb):
    rows, entry, lattice_weight, exit_rgb = boxes(entries).find(rgb)
    assert ((lattice_weight >= 0) & (lattice_weight <= 1)).all()
    assert ((exit_rgb >= 0) & (exit_rgb <= 1)).all()
    mixed = (
        lattice_weight[:, None] * exit_rgb
        + (1 - lattice_weight[:, None]) * entries[entry]
    )
    assert_allclose(
        mixed, rgb[rows], rtol=0, atol=MARGIN
    )  # exact but for entries at the edge


@given(colours, queried)
def test_boxes_are_those_of_an_exhaustive_search(entries, rgb):
    found = boxes(entries)
    pinned = found.find(rgb)
    held = dict(
        zip(
            pinned.rows,
            zip(pinned.entry, pinned.lattice_weight, strict=True),
            strict=True,
        )
    )
    steps = LATTICE.to_steps(rgb)
    middles = LATTICE.to_steps(entries)
    for row in range(len(rgb)):
        apart = (
            np.abs(steps[row] - middles).max(axis=1) if len(entries) else np.zeros(0)
        )
        inside = np.flatnonzero(
            (apart < found.half_width - 1e-9) & (found.half_width > 0)
        )
        if inside.size:
            assert held[row][0] == inside[0]
        elif row in held:
            assert held[row][1] == pytest.approx(1, abs=1e-6)


def test_the_lattice_has_no_weight_at_an_entry():
    entries = np.array([[0.2, 0.3, 0.4], [0.0, 1.0, 0.5], [1 - 3e-16, 0.6, 1e-10]])
    for colours in (
        entries,
        entries.round(9),
    ):  # an entry as good as on the edge answers there too
        rows, entry, lattice_weight, _ = boxes(entries).find(colours)
        assert rows.tolist() == [0, 1, 2]
        assert entry.tolist() == [0, 1, 2]
        assert_allclose(lattice_weight, 0, rtol=0, atol=1e-7)


def test_touched_cells_are_those_of_boxes():
    found = boxes(np.array([[0.2, 0.3, 0.4]]))
    rgb = np.random.default_rng(0).random((500, 3))
    cells = LATTICE.index(LATTICE.cell(rgb)[0])
    assert_array_equal(found.touched_cells[cells], np.isin(cells, found.cells[0]))
    assert found.touched_cells.sum() == len(found.cells[0]) == 27


@given(arrays(float, st.tuples(st.integers(0, 12), st.just(3)), elements=unit))
def test_no_two_boxes_overlap(rgb):
    steps = LATTICE.to_steps(rgb)
    widths = half_widths(steps)
    assert ((widths >= 0) & (widths <= MAX_HALF_WIDTH)).all()
    for first in range(len(rgb)):
        for second in range(first):
            if widths[first] and widths[second]:
                apart = np.abs(steps[first] - steps[second]).max()
                assert widths[first] + widths[second] <= apart + 1e-12


@given(
    arrays(
        float, st.tuples(st.integers(1, 8), st.just(3)), elements=st.floats(-0.3, 1.3)
    )
)
def test_boxes_outside_overlap_neither_each_other_nor_the_space(rgb):
    rgb = rgb[((rgb < 0) | (rgb > 1)).any(axis=1)]
    widths = outside_half_widths(LATTICE, rgb)
    assert ((widths >= 0) & (widths <= MAX_HALF_WIDTH)).all()
    found = OutsideBoxes(rgb, widths / (LATTICE.dim - 1))
    corners = rgb[:, None] + found.half_width[:, None, None] * np.array(
        list(product((-1, 1), repeat=3))
    )
    assert (
        ((corners <= 1e-12).all(axis=1) | (corners >= 1 - 1e-12).all(axis=1))
        .any(axis=1)
        .all()
    )
    hits = found.find(rgb)
    assert (
        hits.rows[hits.rows == hits.entry].tolist() == np.flatnonzero(widths).tolist()
    )
    assert not hits.lattice_weight[hits.rows == hits.entry].any()


def test_the_weight_of_an_entry_outside_is_1_in_its_core_and_0_on_the_faces():
    found = OutsideBoxes(np.array([[-0.1, 0.5, 0.5]]), np.array([0.1]))
    shares = np.array([0, 0.05, 0.1, 0.55, 1 - 1e-9, 1.01])
    hits = found.find(found.rgb + 0.1 * shares[:, None] * [0, -1, 0])
    assert hits.rows.tolist() == [0, 1, 2, 3, 4]
    assert_allclose(hits.lattice_weight, [0, 0, 0, 0.5, 1], rtol=0, atol=1e-8)


def colours_in(data, cell, count=400):
    """Linear RGB (count, 3) in a cell, some on its faces and corners, some at entries
    in it.
    """
    random = np.random.default_rng(cell)
    share = random.random((count, 3))
    share[: count // 2] = np.clip(
        np.round(share[: count // 2] * 1.5 - 0.25, 1), 0, 1 - 1e-12
    )
    low = data.lattice.position(np.array(cell))
    rgb = data.lattice.nodes[low] + share * (
        data.lattice.nodes[low + 1] - data.lattice.nodes[low]
    )
    return rgb[(data.lattice.cell(rgb)[0] == low).all(axis=1)]


def missing(data, required):
    """Count colours that are answered from nodes other than those that ``required``
    returns for them.
    """
    count = 0
    for cell in np.unique(data.entry_boxes.cells[0])[::3]:
        rgb = colours_in(data, cell)
        nodes = around(data, rgb)
        count += int((~required(rgb)[nodes.points]).any(axis=1).sum())
    return count


def required_points(data):
    return lambda rgb: data.entry_boxes.required_points([rgb])


@pytest.mark.parametrize("name", ["small_cube", "macbeth_cube"])
def test_required_points_answer_their_colours(request, name):
    data = request.getfixturevalue(name).data
    assert missing(data, required_points(data)) == 0
    # entry boxes need other points than the corners around a colour
    assert missing(data, lambda rgb: data.lattice.needed(rgb, MARGIN)[1]) > 0


def test_required_points_allow_for_rounding_of_the_colours(plain_cube):
    random = np.random.default_rng(4)
    rgb = random.random((60, 3))
    rgb[:20] = rgb[:20, :1]  # greys lie on the edge between six tetrahedra
    rgb[20:40, 2] = plain_cube.data.lattice.nodes[3]
    required = plain_cube.data.entry_boxes.required_points([rgb])
    moved = np.clip(rgb + random.uniform(-MARGIN, MARGIN, (50, 60, 3)), 0, 1)
    corners, _ = plain_cube.data.lattice.corners(moved.reshape(-1, 3))
    assert required[corners].all()
    assert required.sum() < 8 * len(rgb)


@pytest.mark.parametrize("node", [0, 3, 7])
def test_required_points_allow_for_rounding_across_faces_on_nodes(plain_cube, node):
    data = plain_cube.data
    one = table(
        ("one",),
        np.full((1, 3), data.lattice.nodes[node]),
        data.model,
        np.zeros((1, 9)),
        np.ones(1),
    )
    data = replace(data, atlas=one)
    assert data.entry_boxes.cells[0].size
    assert missing(data, required_points(data)) == 0
