"""Pareto fronts, and placement of labels."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from uplift.viz.scatter import pareto_front, pareto_steps, place_labels

costs, errors = st.sampled_from([1.0, 2.0, 3.0, 10.0]), st.floats(0.01, 10)


@given(st.lists(st.tuples(costs, errors), min_size=1, max_size=12))
def test_front_holds_every_point_that_no_other_dominates(points):
    array = np.array(points)
    front = pareto_front(array)
    assert (np.diff(array[front], axis=0) * [1, -1] > 0).all()
    for cost, error in points:
        assert ((array[front] <= (cost, error)).all(axis=1)).any()


def test_steps_pass_through_the_front():
    steps = pareto_steps(np.array([[1.0, 5.0], [3.0, 2.0]]), 10.0)
    assert steps.tolist() == [[1, 5], [3, 5], [3, 2], [10, 2]]


PANEL = np.array([0.0, 0.0, 300.0, 200.0])


def overlapping(corners, sizes):
    """How many pairs of labels touch."""
    low = np.maximum(corners[:, None], corners)
    high = np.minimum((corners + sizes)[:, None], corners + sizes)
    return int(np.triu((high > low).all(axis=-1), 1).sum())


def test_labels_of_close_points_do_not_overlap():
    anchors = np.random.default_rng(1).normal((290, 100), (3, 12), (9, 2))
    sizes = np.tile([48.0, 9.0], (9, 1))
    corners = place_labels(anchors, sizes, anchors, PANEL)
    assert overlapping(anchors, sizes) > 10
    placed = ~np.isnan(corners).any(axis=1)
    assert placed.sum() >= 5
    corners, sizes = corners[placed], sizes[placed]
    assert overlapping(corners, sizes) == 0
    assert (corners >= PANEL[:2]).all()
    assert (corners + sizes <= PANEL[2:]).all()


def test_labels_without_room_are_left_out():
    anchors, sizes = np.full((2, 2), 100.0), np.array([[40.0, 8.0], [400.0, 8.0]])
    corners = place_labels(anchors, sizes, anchors, PANEL)
    assert np.isnan(corners).any(axis=1).tolist() == [False, True]


def test_single_label_is_next_to_its_point():
    anchors = np.array([[100.0, 100.0]])
    (corner,) = place_labels(anchors, np.array([[40.0, 8.0]]), anchors, PANEL)
    np.testing.assert_allclose(corner, [106, 96])


def test_label_does_not_cover_a_marker():
    anchors, markers = np.array([[100.0, 100.0]]), np.array([[100.0, 100.0], [120.0, 100.0]])
    (corner,) = place_labels(anchors, np.array([[40.0, 8.0]]), markers, PANEL)
    assert not ((markers > corner) & (markers < corner + np.array([40, 8]))).all(axis=1).any()
