"""Entry boxes against their definition."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

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
def test_boxes_are_those_of_an_exhaustive_search_and_mixtures_have_the_colour(
    entries, rgb
):
    found = boxes(entries)
    hits = found.find(rgb)
    weight = hits.lattice_weight[:, None]
    assert ((weight >= 0) & (weight <= 1)).all()
    assert ((hits.exit_rgb >= 0) & (hits.exit_rgb <= 1)).all()
    mixed = weight * hits.exit_rgb + (1 - weight) * entries[hits.entry]
    # Exact but for entries at the edge
    assert_allclose(mixed, rgb[hits.rows], rtol=0, atol=MARGIN)
    held = dict(zip(hits.rows, hits.entry, strict=True))
    apart = LATTICE.to_steps(rgb)[:, None] - LATTICE.to_steps(entries)
    deep = np.abs(apart).max(axis=2) < found.half_width - 1e-9
    for row in range(len(rgb)):
        if deep[row].any():
            assert held[row] == deep[row].argmax()
        elif row in held:
            assert weight[hits.rows == row] == pytest.approx(1, abs=1e-6)


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


@given(
    arrays(
        float, st.tuples(st.integers(1, 8), st.just(3)), elements=st.floats(-0.3, 1.3)
    )
)
def test_boxes_outside_do_not_reach_the_space_and_hold_their_entries(rgb):
    rgb = rgb[((rgb < 0) | (rgb > 1)).any(axis=1)]
    widths = outside_half_widths(LATTICE, rgb)
    assert ((widths >= 0) & (widths <= MAX_HALF_WIDTH)).all()
    found = OutsideBoxes(rgb, widths / (LATTICE.dim - 1))
    low, high = (rgb + side * found.half_width[:, None] for side in (-1, 1))
    assert ((high <= 1e-12) | (low >= 1 - 1e-12)).any(axis=1).all()
    hits = found.find(rgb)
    own = hits.rows == hits.entry
    assert hits.rows[own].tolist() == np.flatnonzero(found.half_width).tolist()
    assert not hits.lattice_weight[own].any()


def test_the_weight_of_an_entry_outside_is_1_in_its_core_and_0_on_the_faces():
    found = OutsideBoxes(np.array([[-0.1, 0.5, 0.5]]), np.array([0.1]))
    shares = np.array([0, 0.05, 0.1, 0.55, 1 - 1e-9, 1.01])
    hits = found.find(found.rgb + 0.1 * shares[:, None] * [0, -1, 0])
    assert hits.rows.tolist() == [0, 1, 2, 3, 4]
    assert_allclose(hits.lattice_weight, [0, 0, 0, 0.5, 1], rtol=0, atol=1e-8)


def colours_in(data, cell):
    """Colours in a cell, half of them on its faces and corners."""
    rng = np.random.default_rng(cell)
    share = rng.random((400, 3))
    share[:200] = np.clip(np.round(share[:200] * 1.5 - 0.25, 1), 0, 1 - 1e-12)
    nodes = data.lattice.nodes
    low = data.lattice.position(np.array(cell))
    rgb = nodes[low] + share * (nodes[low + 1] - nodes[low])
    return rgb[(data.lattice.cell(rgb)[0] == low).all(axis=1)]


@pytest.mark.parametrize("node", [None, 0, 3, 7])
def test_required_points_answer_their_colours(small_cube, plain_cube, node):
    """Also across faces on nodes, where rounding decides."""
    data = small_cube.data
    if node is not None:
        rgb = np.full((1, 3), data.lattice.nodes[node])
        one = table(("one",), rgb, data.model, np.zeros((1, 9)), np.ones(1))
        data = replace(plain_cube.data, atlas=one)
    cells = np.unique(data.entry_boxes.cells[0])
    assert cells.size
    for cell in cells[::3]:
        rgb = colours_in(data, cell)
        required = data.entry_boxes.required_points([rgb])
        assert required[around(data, rgb).points].all()


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
