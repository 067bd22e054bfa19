"""Properties of designs: metamers, bounds, optimality and free colours."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import PaletteError
from uplift.design.palette import design, illuminant, matrix
from uplift.design.palette.colours import screen_matrix
from uplift.design.palette.equations import equations
from uplift.design.palette.palette import ColourGoal, Palette, SpectrumSpec
from uplift.fit.bounded_least_squares import BoundedProblem, solve_bounded

BLACK = np.zeros(3)


@pytest.fixture(scope="module")
def found(metamers, model):
    return design(metamers, model)


def test_metamers_match_by_day_and_differ_under_the_lamp(found, metamers):
    colours = matrix(found)
    targets = metamers.goals[2].rgb, metamers.goals[3].rgb
    day, lamp = (delta_e_rgb(metamers.sensor, *colours.obtained[:, column]) for column in (0, 1))
    assert day <= 0.1
    assert lamp >= delta_e_rgb(metamers.sensor, *targets) - 0.01 > 15
    assert colours.model_error.max() < 0.5


def test_spectra_stay_within_their_bounds(found, metamers, model):
    assert found.reflectances.min() >= -1e-9
    assert found.reflectances.max() <= 1 + 1e-9
    tight = tuple(dataclasses.replace(part, low=0.1, high=0.6) for part in metamers.materials)
    narrow = design(dataclasses.replace(metamers, materials=tight), model).reflectances
    assert narrow.min() >= 0.1 - 1e-9
    assert narrow.max() <= 0.6 + 1e-9


@pytest.mark.parametrize("seed", range(5))
def test_bounded_solutions_satisfy_the_optimality_conditions(sensor, model, seed):
    """Karush–Kuhn–Tucker: zero gradient between the bounds, outward descent at them."""
    problem = equations(at_random(sensor, np.random.default_rng(seed)), model)
    x = solve_bounded(problem)
    assert ((x >= problem.low) & (x <= problem.high)).all()
    slope = problem.matrix.T @ (problem.matrix @ x - problem.values)
    slack = 1e-7 * np.abs(problem.matrix.T @ problem.values).max()
    low, high = x <= problem.low + 1e-12, x >= problem.high - 1e-12
    assert np.abs(slope[~low & ~high]).max(initial=0) < slack
    assert slope[low].min(initial=0) > -slack
    assert slope[high].max(initial=0) < slack


def at_random(sensor, draw):
    """Up to three given lights and three open materials with goals that may contradict one another."""
    names = draw.choice(["D65", "A", "FL2", "FL11", "LED-RGB1", "HP1"], draw.integers(1, 4), replace=False)
    lights = tuple(SpectrumSpec(str(name), illuminant(sensor, str(name))) for name in names)
    materials = tuple(SpectrumSpec(f"m{row}", None) for row in range(draw.integers(1, 4)))
    goals = [
        ColourGoal(material.name, light.name, **({"free": "x"} if draw.random() < 0.3 else {"rgb": draw.random(3)}))
        for material in materials
        for light in lights
    ]
    weights = {"smoothness": float(draw.choice([0, 1e-3])), "model_error": float(draw.choice([0, 0.1, 1]))}
    return Palette(sensor, lights, materials, tuple(goals), {"x": (BLACK, np.ones(3))}, **weights)


def test_unbounded_solutions_are_those_of_the_pseudo_inverse():
    """The minimum of least norm."""
    draw = np.random.default_rng(1)
    rows, values, wide = draw.random((4, 9)), draw.random(4), np.full(9, np.inf)
    x = solve_bounded(BoundedProblem(rows, values, -wide, wide))
    np.testing.assert_allclose(x, np.linalg.pinv(rows) @ values, atol=1e-12)


def test_independent_blocks_are_solved_separately():
    """The solution does not depend on the order of rows and columns."""
    draw = np.random.default_rng(2)
    first, second = draw.random((5, 4)), draw.random((6, 3))
    matrix = np.zeros((11, 8))  # the last column has no equation
    matrix[:5, :4], matrix[5:, 4:7] = first, second
    rows, columns = draw.permutation(11), draw.permutation(8)
    values, low, high = draw.random(11), np.full(8, 0.1), np.full(8, 0.6)
    found = solve_bounded(BoundedProblem(matrix[np.ix_(rows, columns)], values[rows], low, high))
    expected = [
        lsq_linear(block, part, (0.1, 0.6), method="bvls").x
        for block, part in ((first, values[:5]), (second, values[5:]))
    ]
    np.testing.assert_allclose(found, np.append(np.concatenate(expected), 0.1)[columns], atol=1e-9)


def test_a_free_colour_stays_within_its_range(metamers, model):
    low, high = np.array([0.05, 0.2, 0.1]), np.array([0.2, 0.3, 0.15])
    free = design(dataclasses.replace(metamers, free={"coat": (low, high)}), model).free["coat"]
    assert ((free >= low - 1e-9) & (free <= high + 1e-9)).all()


def test_lights_are_designed_like_materials(metamers, model):
    """Colours of two paints under a lamp determine a light with the same colours."""
    paints = SpectrumSpec("red", np.linspace(0, 1, 81) ** 2), SpectrumSpec("blue", np.linspace(1, 0, 81) ** 2)
    power, screen = illuminant(metamers.sensor, "A"), screen_matrix(metamers.sensor)
    palette = dataclasses.replace(
        metamers,
        lights=(SpectrumSpec("odd", None, 0.0, np.inf),),
        materials=paints,
        goals=tuple(ColourGoal(part.name, "odd", rgb=screen @ (power * part.samples)) for part in paints),
        free={},
    )
    found = design(palette, model)
    assert matrix(found).delta_e.max() < 0.1
    assert found.powers.min() >= 0


@pytest.mark.parametrize(
    ("weight", "measure"),
    [
        ("smoothness", lambda found: np.abs(np.diff(found.reflectances, 2)).sum()),
        ("model_error", lambda found: matrix(found).model_error.sum()),
    ],
)
def test_a_larger_weight_reduces_its_error(metamers, model, weight, measure):
    low, high = (design(dataclasses.replace(metamers, **{weight: w}), model) for w in (0.003, 0.3))
    assert measure(high) < measure(low)


def test_a_goal_with_open_light_and_material_is_refused(metamers, model):
    lights = (SpectrumSpec("day", None, 0.0, np.inf), metamers.lights[1])
    with pytest.raises(PaletteError) as caught:
        design(dataclasses.replace(metamers, lights=lights), model)
    assert "fox under day" in caught.value.problem


def test_colours_of_the_factor_model_can_be_fitted(metamers, model):
    """Equation 19: the goals hold in the factor model, and no longer in full spectra."""
    weights = {"model_error": 0.0, "smoothness": 0.0}
    found = design(dataclasses.replace(metamers, fit="factor-model", **weights), model)
    target = np.array([found.free["coat"], found.free["coat"]])
    np.testing.assert_allclose(matrix(found).factor[:, 0], target, atol=1e-6)
    assert matrix(found).delta_e.max() < 0.01
    assert np.abs(matrix(found).obtained[:, 0] - target).max() > 1e-4


def test_a_light_can_be_fitted_in_the_factor_model(metamers, model):
    materials = tuple(dataclasses.replace(each, samples=np.linspace(0.2, 0.7, 81)) for each in metamers.materials[:1])
    lights = (SpectrumSpec("veil", None, 0.0, np.inf),)
    goals = (ColourGoal(materials[0].name, "veil", np.array([0.3, 0.2, 0.1])),)
    palette = dataclasses.replace(
        metamers,
        materials=materials,
        lights=lights,
        goals=goals,
        free={},
        min_differences=(),
        model_error=0.0,
        fit="factor-model",
    )
    assert matrix(design(palette, model)).delta_e.max() < 0.1
