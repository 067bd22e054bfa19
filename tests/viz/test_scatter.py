"""Pareto fronts."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from uplift.viz.scatter import pareto_front, pareto_steps

costs, errors = st.sampled_from([1.0, 2.0, 3.0, 10.0]), st.floats(0.01, 10)


@given(st.lists(st.tuples(costs, errors), min_size=1, max_size=12))
def test_front_holds_every_point_that_no_other_dominates(points):
    array = np.array(points)
    front = pareto_front(array)
    assert (np.diff(array[front], axis=0) * [1, -1] > 0).all()
    for cost, error in points:
        assert ((array[front] <= (cost, error)).all(axis=1)).any()


def test_front_of_no_points_is_empty():
    assert pareto_front(np.empty((0, 2))) == []


def test_steps_pass_through_the_front():
    steps = pareto_steps(np.array([[1.0, 5.0], [3.0, 2.0]]), 10.0)
    assert steps.tolist() == [[1, 5], [3, 5], [3, 2], [10, 2]]


def test_steps_of_an_empty_front_are_empty():
    assert pareto_steps(np.empty((0, 2)), 10.0).shape == (0, 2)
