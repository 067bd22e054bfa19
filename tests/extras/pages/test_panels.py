"""Figures of panels: labels that cover nothing, axes, legends and scales."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uplift.extras.pages.figure import to_svg
from uplift.extras.pages.panels import Axis, Dot, Panel, draw
from uplift.extras.pages.pareto import CLEAR_RATIO, pareto_front


def boxes_of(axes):
    """Boxes in pixels of the labels that were written."""
    return [text.get_window_extent() for text in axes.texts if text.get_text()]


@pytest.mark.parametrize("log", [False, True])
def test_labels_cover_no_label_and_no_dot_and_stay_inside(log):
    places = np.exp(np.random.default_rng(1).normal((3, 1), (0.4, 0.3), (24, 2)))
    dots = [Dot(x, y, f"label {row}") for row, (x, y) in enumerate(places.tolist())]
    figure = draw([Panel(x=Axis(log=log), y=Axis(log=log), dots=dots)])
    (axes,) = figure.axes
    boxes = boxes_of(axes)
    assert len(boxes) > 12
    for first, second in itertools.combinations(boxes, 2):
        assert not first.overlaps(second)
    for box in boxes:
        assert not box.count_contains(axes.transData.transform(places))
        assert axes.get_window_extent().count_contains(box.corners()) == 4


def test_markers_and_labels_have_their_keys_in_svg():
    svg = to_svg(draw([Panel(dots=[Dot(1, 2, "here", key="0-7"), Dot(3, 4)])]))
    assert svg.count('id="marker-0-7"') == svg.count('id="label-0-7"') == 1
    assert svg.count("marker-") == 1


costs = st.sampled_from([1.0, 10.0, 11.0, 100.0, 1e5])
errors = st.floats(1e-6, 10)


@settings(max_examples=30)
@given(st.lists(st.tuples(costs, errors), min_size=1, max_size=12))
def test_front_is_clearly_more_accurate_than_all_cheaper_points(points):
    front = [points[row] for row in pareto_front(points)]
    for (cost, error), (dearer, smaller) in itertools.pairwise(front):
        assert cost < dearer
        assert smaller < CLEAR_RATIO * error
    for cost, error in points:
        assert any(
            cheap <= cost and CLEAR_RATIO * small <= error for cheap, small in front
        )
