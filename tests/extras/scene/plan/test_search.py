"""The search against all candidates of small spaces, with errors that are injected, and
of a real scene.
"""

from dataclasses import replace
from itertools import product
from typing import get_args

import numpy as np
import pytest

from tests.extras.scene.plan.conftest import SMALL
from uplift.extras.scene import plan
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


def measured(candidate, error):
    return replace(
        candidate,
        error=ErrorSummary((GroupError("textures", "D65", error, error, error),)),
    )


def independent_errors(rng, choice, samples):
    """Coarse cubes and few samples have errors that add in squares, but for a factor
    from 0.9 to 1.3.
    """
    return rng.uniform(0.9, 1.3) * np.hypot(
        9 / choice.dim + 4 / choice.coefficients**1.5, 30 / samples**2
    )


def arbitrary_errors(rng, choice, samples):
    return rng.uniform(0.1, 3)


def small_space(errors, seed, looseness=1.0):
    """72 candidates with bounds from 0.5 to 1 of their true errors, times the
    ``looseness``, and measured ones.
    """
    rng = np.random.default_rng(seed)
    truth = {}
    for count, dim, samples, pixel in product(
        (3, 5, 9), (4, 8, 12), (3, 5, 7, 9), PIXELS
    ):
        choice = Options(dim=dim, coefficients=count)
        memory = count * dim**3 / 10 + 100 * (samples if pixel.depth else 3)
        cost = Cost(memory, samples * 7 + (not pixel.depth) * count, samples)
        error = errors(rng, choice, samples)
        candidate = Candidate(
            pixel, cost, None, choice, bound=error * rng.uniform(0.5, 1) * looseness
        )
        truth[candidate] = measured(candidate, error)
    return truth


def cheapest_cost(candidates, tolerance, minimise, limits):
    found = sufficient(candidates, tolerance, minimise, limits)
    return found[0].cost.ranked(minimise) if found else None


def explored(truth):
    return explore(truth, lambda choice, batch: [truth[each] for each in batch], 0.0)


MINIMISE = get_args(Minimised)
CHOICES = list(product((0.4, 0.8, 1.2, 2.0), MINIMISE, LIMITS))


@pytest.mark.parametrize("errors", [independent_errors, arbitrary_errors])
@pytest.mark.parametrize("seed", range(5))
def test_no_cheaper_candidate_of_a_small_space_suffices(errors, seed):
    truth = small_space(errors, seed)
    found = explored(truth)
    for tolerance, minimise, limits in CHOICES:
        expected = cheapest_cost(truth.values(), tolerance, minimise, limits)
        assert cheapest_cost(found, tolerance, minimise, limits) == expected
    everything = pareto_front(list(truth.values()))
    assert sorted(positions(pareto_front(found)).tolist()) == sorted(
        positions(everything).tolist()
    )
    assert len(found) < len(truth)


def test_the_check_can_fail():
    wrong = 0
    for seed in range(5):
        truth = small_space(arbitrary_errors, seed, looseness=4)
        found = explored(truth)
        wrong += sum(
            cheapest_cost(found, *each) != cheapest_cost(truth.values(), *each)
            for each in CHOICES
        )
    assert wrong


def test_the_front_has_what_nothing_dominates():
    rows = np.random.default_rng(0).integers(0, 4, (60, 4))
    candidates = [
        measured(Candidate(PIXELS[0], Cost(*row[:3])), float(row[3])) for row in rows
    ]
    front = positions(pareto_front(candidates))
    for row in rows:
        assert any((kept <= row).all() for kept in front)
        assert not any((row <= kept).all() and (row < kept).any() for kept in front)
    assert len(np.unique(front, axis=0)) == len(front)


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_bounds_of_a_real_scene_exclude_no_cheaper_candidate(
    kitchen, planned, monkeypatch
):
    scene = plan.read_scene_file(kitchen)
    monkeypatch.setattr("uplift.extras.scene.plan.space.MARGIN", 0.0)
    everything = plan.plan(scene, SMALL).measured
    found, _ = planned
    assert len(found.measured) <= len(everything) <= found.considered
    for tolerance, minimise in product((2.5, 4.0, 6.0), MINIMISE):
        expected = cheapest_cost(everything, tolerance, minimise, {})
        assert cheapest_cost(found.measured, tolerance, minimise, {}) == expected
