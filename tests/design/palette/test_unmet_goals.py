"""Missed goals and the relaxations that meet them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from uplift.design.palette import design, unmet_goals
from uplift.design.palette.palette import ColourGoal, MinDifference, SpectrumSpec


@pytest.fixture
def black(metamers):
    """A paint that reflects at least 10 %, with the goals of grey by day and black under the lamp."""
    goals = (ColourGoal("soot", "day", rgb=np.full(3, 0.2)), ColourGoal("soot", "lamp", rgb=np.zeros(3)))
    return dataclasses.replace(metamers, materials=(SpectrumSpec("soot", None, 0.1, 1),), goals=goals, free={})


def test_an_infeasible_goal_is_missed(black, model):
    missed = unmet_goals(design(black, model))
    (lamp,) = (each for each in missed if each.goal is black.goals[1])
    assert lamp.delta_e > 10
    assert str(lamp).startswith(f"soot under lamp: missed by ΔE00 {lamp.delta_e:.2f}; relax the bounds of soot")


def test_the_suggested_relaxation_meets_the_goal(black, model):
    """Without bounds the goal is met with the reported ΔE00."""
    lamp = unmet_goals(design(black, model))[-1]
    relief = next(one for one in lamp.relaxations if one.criterion == "the bounds of soot")
    wide = dataclasses.replace(black, materials=(SpectrumSpec("soot", None, -np.inf, np.inf),))
    remaining = unmet_goals(design(wide, model))
    assert relief.delta_e < 0.5
    assert not remaining


def test_contradicting_goals_name_one_another(metamers, model):
    """One spectrum under one light cannot have two colours."""
    paint = SpectrumSpec("paint", np.full(81, 0.4))
    goals = (
        ColourGoal("paint", "odd", rgb=np.full(3, 0.3)),
        ColourGoal("ditto", "odd", rgb=np.array([0.1, 0.3, 0.3])),
    )
    palette = dataclasses.replace(
        metamers,
        lights=(SpectrumSpec("odd", None, 0, np.inf),),
        materials=(paint, SpectrumSpec("ditto", paint.samples)),
        goals=goals,
        free={},
    )
    texts = [str(each) for each in unmet_goals(design(palette, model))]
    assert len(texts) == 2
    assert "relax the weight of ditto under odd" in texts[0]
    assert "relax the weight of paint under odd" in texts[1]


def test_a_feasible_palette_has_no_unmet_goals(metamers, model):
    assert unmet_goals(design(metamers, model)) == ()


def test_materials_that_differ_too_little_are_reported(metamers, model):
    pair = MinDifference(("fox", "moss"), "day", 5.0)
    (unmet,) = unmet_goals(design(dataclasses.replace(metamers, min_differences=(pair,)), model))
    assert unmet.goal is pair
    assert unmet.delta_e < 0.1
    assert str(unmet).startswith("fox and moss under day: ΔE00 must be at least 5, got 0.0")


def test_goals_of_zero_weight_are_not_missed(black, model):
    idle = tuple(dataclasses.replace(wish, weight=0.0) for wish in black.goals)
    assert unmet_goals(design(dataclasses.replace(black, goals=idle), model)) == ()
