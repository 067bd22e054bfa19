"""Missed goals and the relaxations that meet them; palettes with few entries or goals have finite results."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from uplift.design.palette import design, matrix, read_palette, unmet_goals
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
    relief = dict(lamp.relaxations)["the bounds of soot"]
    wide = dataclasses.replace(black, materials=(SpectrumSpec("soot", None, -np.inf, np.inf),))
    remaining = unmet_goals(design(wide, model))
    assert relief < 0.5
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


def test_materials_that_differ_too_little_are_reported(metamers, model):
    pair = MinDifference(("fox", "moss"), "day", 5.0)
    (unmet,) = unmet_goals(design(dataclasses.replace(metamers, min_differences=(pair,)), model))
    assert unmet.goal is pair
    assert unmet.delta_e < 0.1
    assert str(unmet).startswith("fox and moss under day: ΔE00 must be at least 5, got 0.0")


def test_goals_of_zero_weight_are_not_missed(black, model):
    idle = tuple(dataclasses.replace(wish, weight=0.0) for wish in black.goals)
    assert unmet_goals(design(dataclasses.replace(black, goals=idle), model)) == ()


DAY, GIVEN, NEW = (
    'lights.day.illuminant = "D65"\n',
    'materials.grey.rgb = "#808080"\n',
    "materials.new.design = true\n",
)


@pytest.mark.parametrize(
    "text",
    [
        DAY + GIVEN,
        "smoothness = 0\nmodel-error = 0\n" + DAY + "materials.new = { design = true, bounds = false }",
        "lights.odd.design = true\n" + NEW,
        DAY + NEW + 'colours.new.day = { free = "alone" }',
        DAY + NEW + 'colours.new.day = { rgb = "#ff0000", weight = 1000000 }',
        'lights.off = { illuminant = "D65", luminance = 0 }\n' + NEW + 'colours.new.off = "#000000"',
    ],
)
def test_all_results_are_finite(model, tmp_path, text):
    (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
    found = design(read_palette(tmp_path / "spec.toml"), model)
    colours = matrix(found)
    for numbers in (found.powers, found.reflectances, colours.obtained, colours.factor, colours.model_error):
        assert np.isfinite(numbers).all()
    assert unmet_goals(found) == ()
