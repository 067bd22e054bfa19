"""The search against all candidates of small spaces, with errors that are injected."""

from dataclasses import replace
from itertools import product
from typing import get_args

import numpy as np
import pytest

from uplift.extras.scene.plan.candidates import Candidate, Cost, Pixel
from uplift.extras.scene.plan.evaluation import ErrorSummary, GroupError
from uplift.extras.scene.plan.files import Minimised
from uplift.extras.scene.plan.search import (
    explore,
    pareto_front,
    positions,
    sufficient,
)
from uplift.pipeline.options import Options

PIXELS = (Pixel("spectrum", "half"), Pixel("rgb", mode="moments"))
LIMITS = ({}, {"samples": 5}, {"samples": 6, "memory": 900.0}, {"time": 40.0})
MINIMISE = get_args(Minimised)


def measured(candidate, error):
    part = GroupError("textures", "D65", error, error, error)
    return replace(candidate, error=ErrorSummary((part,)))


def small_space(seed):
    """72 candidates with arbitrary errors and bounds from 0.5 to 1 of them, and
    measured ones.
    """
    rng = np.random.default_rng(seed)
    truth = {}
    sizes = product((3, 5, 9), (4, 8, 12), (3, 5, 7, 9), PIXELS)
    for count, dim, samples, pixel in sizes:
        memory = count * dim**3 / 10 + 100 * (samples if pixel.depth else 3)
        cost = Cost(memory, samples * 7 + (not pixel.depth) * count, samples)
        error = rng.uniform(0.1, 3)
        bound = error * rng.uniform(0.5, 1)
        options = Options(dim=dim, coefficients=count)
        candidate = Candidate(pixel, cost, None, options, bound=bound)
        truth[candidate] = measured(candidate, error)
    return truth


def cheapest_cost(candidates, tolerance, minimise, limits):
    found = sufficient(candidates, tolerance, minimise, limits)
    return found[0].cost.ranked(minimise) if found else None


def rows_of_front(candidates):
    return sorted(positions(pareto_front(candidates)).tolist())


@pytest.mark.parametrize("seed", range(5))
def test_no_cheaper_candidate_of_a_small_space_suffices(seed):
    truth = small_space(seed)
    found = explore(truth, lambda choice, batch: [truth[each] for each in batch], 0.0)
    everything = list(truth.values())
    for choice in product((0.4, 0.8, 1.2, 2.0), MINIMISE, LIMITS):
        assert cheapest_cost(found, *choice) == cheapest_cost(everything, *choice)
    assert rows_of_front(found) == rows_of_front(everything)
    assert len(found) < len(truth)


def test_the_front_has_what_nothing_dominates():
    rows = np.random.default_rng(0).integers(0, 4, (60, 4))
    candidates = [
        measured(Candidate(PIXELS[0], Cost(*row[:3])), float(row[3])) for row in rows
    ]
    front = positions(pareto_front(candidates))
    for row in rows:
        assert (front <= row).all(axis=1).any()
        dominated = (row <= front).all(axis=1) & (row < front).any(axis=1)
        assert not dominated.any()
    assert len(np.unique(front, axis=0)) == len(front)
