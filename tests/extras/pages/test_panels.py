"""Figures of panels: labels that cover nothing, axes, legends and scales."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uplift.extras.pages.figure import to_svg
from uplift.extras.pages.panels import Axis, Dot, Panel, draw
from uplift.extras.pages.pareto import CLEAR_RATIO, front_panel, pareto_front


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


def test_bold_labels_come_first_and_a_label_without_room_is_left_out():
    crowd = [Dot(1, 1, "crowded " * 3) for _ in range(40)]
    (axes,) = draw([Panel(dots=[*crowd, Dot(1, 1, "chosen", bold=True)])]).axes
    assert "chosen" in [text.get_text() for text in axes.texts]
    assert len(axes.texts) < len(crowd)


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


def test_the_front_is_a_staircase_through_points_with_texts():
    points = [(1, 3.0), (2, 3.0 * CLEAR_RATIO), (3, 2.0), (4, 2.5), (5, 1.0)]
    dots = [Dot(x, y, f"{x}") for x, y in points]
    panel = front_panel("title", Axis("cost", log=True), dots[:1], dots[1:])
    assert {dot.text for dot in panel.dots if dot.bold} == {"1", "3", "5"}
    (axes,) = draw([panel]).axes
    front = axes.lines[-1].get_xydata()
    assert front[:-1].tolist() == [[1, 3], [3, 3], [3, 2], [5, 2], [5, 1]]
