"""Rows of the stacked equations against the criteria that they stand for."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from uplift.design.palette.colours import screen_matrix
from uplift.design.palette.equations import SPACING, equations, unknowns
from uplift.design.palette.palette import SpectrumSpec


def guess_for(palette):
    return np.random.default_rng(5).random(max(position.stop for position in unknowns(palette).values()))


@pytest.fixture
def guess(metamers):
    return guess_for(metamers)


def residuals(palette, model, x):
    problem = equations(palette, model)
    return problem.matrix @ x - problem.values


def only(palette, **weights):
    """The palette with only the given criteria."""
    return dataclasses.replace(palette, **{"smoothness": 0.0, "model_error": 0.0} | weights)


def test_colour_residuals_are_differences_to_the_target(metamers, model, guess):
    where, screen = unknowns(metamers), screen_matrix(metamers.sensor)
    found = []
    for goal in metamers.goals:
        power = metamers.light(goal.light).samples
        target = guess[where["free", "coat"]] if goal.free else goal.rgb
        found.append(screen @ (guess[where["material", goal.material]] * power) - target)
    expected = np.concatenate(found) / np.sqrt(3)
    np.testing.assert_allclose(residuals(only(metamers), model, guess), expected, atol=1e-12)


def test_weights_scale_only_their_goal(metamers, model, guess):
    heavy = dataclasses.replace(metamers.goals[2], weight=7.0)
    palette = only(metamers, goals=(*metamers.goals[:2], heavy, metamers.goals[3]))
    ratio = residuals(palette, model, guess) / residuals(only(metamers), model, guess)
    np.testing.assert_allclose(ratio, [*[1] * 6, *[7] * 3, *[1] * 3])


def test_goals_of_zero_weight_have_no_rows(metamers, model):
    idle = tuple(dataclasses.replace(goal, weight=0.0) for goal in metamers.goals)
    assert len(equations(only(metamers, goals=idle), model).values) == 0


def test_smoothness_is_the_second_difference_over_10_nm(metamers, model, guess):
    palette = only(metamers, goals=(), smoothness=2.0)
    where, step = unknowns(metamers), 5.0
    expected = [
        -np.diff(guess[where["material", name]], 2) * 2.0 * (SPACING / step) ** 2 / np.sqrt(79 * 6)
        for name in ("fox", "moss")
    ]
    np.testing.assert_allclose(residuals(palette, model, guess), np.concatenate(expected), atol=1e-12)


def test_model_error_residuals_are_differences_between_colours(metamers, model, guess):
    """Also for a designed light on a given paint."""
    paint = SpectrumSpec("paint", np.linspace(0.1, 0.9, 81))
    palette = only(
        metamers, lights=(*metamers.lights, SpectrumSpec("odd", None)), materials=(*metamers.materials, paint)
    )
    palette = dataclasses.replace(palette, model_error=3.0, goals=())
    where, screen = unknowns(palette), screen_matrix(palette.sensor)
    x = guess_for(palette)
    expected = []
    for material in palette.materials:
        for light in palette.lights:
            surface, power = material.samples, light.samples
            if (surface is None) == (power is None):
                continue
            surface = x[where["material", material.name]] if surface is None else surface
            power = x[where["light", light.name]] if power is None else power
            obtained = model.rgb(model.light(power) * model.reflectance(surface))
            expected.append(3.0 / np.sqrt(3) * (screen @ (power * surface) - obtained))
    np.testing.assert_allclose(residuals(palette, model, x), np.concatenate(expected), atol=1e-10)
