"""Laws of the interpolation: weights sum to 1, nodes keep their values, cells agree on common faces."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.lattice import weighted_sum
from uplift.lookup.interpolate import around

colours = arrays(float, (5, 3), elements=st.floats(0, 1))
FACES = st.tuples(st.integers(1, 6), st.integers(0, 2), arrays(float, 3, elements=st.floats(0, 1)))


@given(rgb=colours)
def test_weights_are_a_partition_of_unity_including_entries(small_cube, rgb):
    nodes = around(small_cube.data, rgb)
    assert (nodes.weights >= 0).all()
    assert ((nodes.lattice_weight >= 0) & (nodes.lattice_weight <= 1)).all()
    data = small_cube.data
    ones = nodes.weighted_sum(np.ones((data.lattice.size, 1)), np.ones((len(data.atlas.names), 1)))
    np.testing.assert_allclose(ones, 1, atol=1e-14)


@given(rgb=colours)
def test_nodes_reproduce_the_colour_including_entries(small_cube, rgb):
    data = small_cube.data
    found = around(data, rgb).weighted_sum(data.lattice.points, data.atlas.rgb)
    np.testing.assert_allclose(found, rgb, atol=1e-12)


@given(face=FACES)
def test_both_cells_of_a_face_agree_on_it(small_cube, face):
    """The upper cell at its lower end, and the lower cell at its upper end."""
    node, axis, rgb = face
    data = small_cube.data
    rgb = rgb.copy()
    rgb[axis] = data.lattice.nodes[node]
    low, fraction = data.lattice.cell(rgb[None])
    assert (low[0, axis], fraction[0, axis]) == (node, 0)
    below, end = low.copy(), fraction.copy()
    below[0, axis], end[0, axis] = node - 1, 1
    upper, lower = (
        weighted_sum(data.points.coefficients, *data.lattice.cell_corners(cell, part))
        for cell, part in ((low, fraction), (below, end))
    )
    np.testing.assert_allclose(lower, upper, rtol=0, atol=1e-15)
