"""What cannot be had is told, with what would help."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from uplift.design.palette import design, unmet_goals
from uplift.design.palette.palette import ColourGoal, MinDifference, SpectrumSpec


@pytest.fixture
def black(metamers):
    """A paint of at least 10 % that shall be black under the lamp, and grey by day."""
    goals = (ColourGoal("soot", "day", rgb=np.full(3, 0.2)), ColourGoal("soot", "lamp", rgb=np.zeros(3)))
    return dataclasses.replace(
        metamers, materials=(SpectrumSpec("soot", None, 0.1, 1),), goals=goals, free={}
    )


def test_a_wish_that_no_paint_fulfils_is_missed(black, model):
    missed = unmet_goals(design(black, model))
    (lamp,) = (miss for miss in missed if miss.goal is black.goals[1])
    assert lamp.delta_e > 10
    assert str(lamp).startswith(
        f"soot under lamp: missed by ΔE00 {lamp.delta_e:.2f}; relax the bounds of soot"
    )


def test_what_it_says_would_help_helps(black, model):
    """Without bounds the wish is fulfilled, to the ΔE00 that was told."""
    lamp = unmet_goals(design(black, model))[-1]
    relief = next(one for one in lamp.relaxations if one.criterion == "the bounds of soot")
    wide = dataclasses.replace(black, materials=(SpectrumSpec("soot", None, -np.inf, np.inf),))
    left = unmet_goals(design(wide, model))
    assert relief.delta_e < 0.5
    assert not left


def test_wishes_that_contradict_one_another_name_one_another(metamers, model):
    """One paint under one light cannot be two colours, shared by two wishes."""
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
    told = [str(miss) for miss in unmet_goals(design(palette, model))]
    assert len(told) == 2
    assert "relax the weight of ditto under odd" in told[0]
    assert "relax the weight of paint under odd" in told[1]


def test_nothing_is_missed_where_all_is_well(metamers, model):
    assert unmet_goals(design(metamers, model)) == ()


def test_materials_that_lie_nearer_than_asked_are_told(metamers, model):
    apart = MinDifference(("fox", "moss"), "day", 5.0)
    (miss,) = unmet_goals(design(dataclasses.replace(metamers, min_differences=(apart,)), model))
    assert str(miss).startswith("fox and moss under day: ΔE00 0.0")
    assert "not 5" in str(miss)


def test_what_has_no_weight_is_not_missed(black, model):
    idle = tuple(dataclasses.replace(wish, weight=0.0) for wish in black.goals)
    assert unmet_goals(design(dataclasses.replace(black, goals=idle), model)) == ()
