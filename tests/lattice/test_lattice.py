"""The lattice: numbering, cells, weights, neighbours."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.lattice.lattice import Lattice

UNEVEN = Lattice(np.array([0.0, 0.01, 0.2, 0.7, 1.0]))
colours = arrays(float, (7, 3), elements=st.floats(0, 1))


def test_points_are_numbered_blue_fastest():
    assert_array_equal(UNEVEN.points[1], [0, 0, 0.01])
    assert_array_equal(UNEVEN.points[5], [0, 0.01, 0])
    assert_array_equal(UNEVEN.points[25], [0.01, 0, 0])
    assert len(UNEVEN.points) == UNEVEN.size == 125


def test_index_and_position_are_inverse():
    every = np.arange(UNEVEN.size)
    assert_array_equal(UNEVEN.index(UNEVEN.position(every)), every)


@given(colours)
def test_weights_are_a_partition_of_unity_and_reproduce_the_colour(rgb):
    points, weights = UNEVEN.corners(rgb)
    assert (weights >= 0).all()
    assert_allclose(weights.sum(axis=1), 1, atol=1e-14)
    assert_allclose(
        (weights[:, :, None] * UNEVEN.points[points]).sum(axis=1), rgb, atol=1e-14
    )


@given(colours)
def test_corners_lead_along_the_axes_in_the_order_of_falling_fractions(rgb):
    rgb[0] = rgb[0, 0]  # a grey, whose fractions are equal
    rgb[1, 2] = rgb[1, 0]
    points, weights = UNEVEN.corners(rgb)
    for colour, corners, shares in zip(rgb, points, weights, strict=True):
        low, fraction = (part[0] for part in UNEVEN.cell(colour[None]))
        path = [low]
        for axis in sorted(range(3), key=lambda axis: -fraction[axis]):
            path.append(path[-1] + np.eye(3, dtype=int)[axis])
        assert corners.tolist() == UNEVEN.index(np.array(path)).tolist()
        ends = [1, *sorted(fraction, reverse=True), 0]
        assert_allclose(shares, -np.diff(ends), rtol=0, atol=1e-15)


def test_neighbours_are_those_within_one_step():
    around, inside = UNEVEN.neighbours(np.arange(UNEVEN.size))
    position = UNEVEN.position(np.arange(UNEVEN.size))
    apart = np.abs(position[:, None] - position[None]).max(axis=-1)
    for point in range(UNEVEN.size):
        assert set(around[point, inside[point]]) == set(
            np.flatnonzero(apart[point] == 1)
        )


@pytest.mark.parametrize(
    "nodes", [[0.0], [0.0, 0.0], [1.0, 0.0], [[0.0, 1.0]], [0.0, np.nan]]
)
def test_nodes_must_increase(nodes):
    with raises(OptionError, "option"):
        Lattice(np.array(nodes))
