"""Designs: bounds, optimality, missed goals, rows of the equations against their
criteria, and atlases.
"""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import raises, warns
from uplift.common.errors import PaletteError
from uplift.extras.papers.palette.colours import illuminant, screen_matrix
from uplift.extras.papers.palette.design import design, matrix, write_designed
from uplift.extras.papers.palette.equations import SPACING, equations, solve, unknowns
from uplift.extras.papers.palette.palette import ColourGoal, Palette, SpectrumSpec
from uplift.extras.papers.palette.spec import read_palette
from uplift.extras.papers.palette.unmet import unmet_goals

NEW = "materials.new.design = true\n"


@pytest.fixture
def read(tmp_path):
    """A function that reads a palette from text."""

    def read(text):
        (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
        return read_palette(tmp_path / "spec.toml")

    return read


def test_spectra_and_free_colours_stay_within_their_bounds(metamers, model):
    tight = tuple(replace(part, low=0.1, high=0.6) for part in metamers.materials)
    low = np.array([0.05, 0.2, 0.1])
    high = np.array([0.2, 0.3, 0.15])
    narrow = replace(metamers, materials=tight, free={"coat": (low, high)})
    found = design(narrow, model)
    assert found.reflectances.min() >= 0.1 - 1e-9
    assert found.reflectances.max() <= 0.6 + 1e-9
    coat = found.free["coat"]
    assert ((coat >= low - 1e-9) & (coat <= high + 1e-9)).all()


@pytest.mark.parametrize("seed", range(5))
def test_bounded_solutions_satisfy_the_optimality_conditions(sensor, model, seed):
    """Karush–Kuhn–Tucker: zero gradient between the bounds, outward descent at them."""
    problem = equations(at_random(sensor, np.random.default_rng(seed)), model)
    x = solve(problem)
    assert ((x >= problem.low) & (x <= problem.high)).all()
    slope = problem.matrix.T @ (problem.matrix @ x - problem.values)
    slack = 1e-7 * np.abs(problem.matrix.T @ problem.values).max()
    low = x <= problem.low + 1e-12
    high = x >= problem.high - 1e-12
    assert np.abs(slope[~low & ~high]).max(initial=0) < slack
    assert slope[low].min(initial=0) > -slack
    assert slope[high].max(initial=0) < slack


def at_random(sensor, draw):
    """Given lights and open materials with goals that may contradict one another."""
    names = draw.choice(["D65", "A", "FL2", "FL11", "HP1"], 2, replace=False)
    lights = tuple(SpectrumSpec(str(name), illuminant(sensor, name)) for name in names)
    materials = tuple(SpectrumSpec(name, None) for name in ("one", "two", "three"))
    goals = []
    for material, light in product(materials, lights):
        aim = {"free": "x"} if draw.random() < 0.3 else {"rgb": draw.random(3)}
        goals.append(ColourGoal(material.name, light.name, **aim))
    return Palette(
        sensor,
        lights,
        materials,
        tuple(goals),
        {"x": (np.zeros(3), np.ones(3))},
        smoothness=float(draw.choice([0, 1e-3])),
        model_error=float(draw.choice([0, 0.1, 1])),
    )


def test_a_goal_with_open_light_and_material_is_refused(read, model):
    palette = read("lights.odd.design = true\n" + NEW + 'colours.new.odd = "#888888"')
    with raises(PaletteError) as caught:
        design(palette, model)
    assert "new under odd" in caught.value.problem


def test_colours_of_the_factor_model_can_be_fitted(metamers, model):
    """Equation 19: the goals hold in the factor model, and no longer in
    full spectra.
    """
    weights = {"model_error": 0.0, "smoothness": 0.0}
    found = design(replace(metamers, fit="factor-model", **weights), model)
    target = np.array([found.free["coat"], found.free["coat"]])
    assert_allclose(matrix(found).factor[:, 0], target, atol=1e-6)
    assert matrix(found).delta_e.max() < 0.01
    assert np.abs(matrix(found).obtained[:, 0] - target).max() > 1e-4


def test_contradicting_goals_name_one_another(read, model):
    """One spectrum under one light cannot have two colours."""
    given = "lights.odd.design = true\n"
    for name, colour in (("one", "#aaaaaa"), ("two", "#558888")):
        given += f'materials.{name}.rgb = "#888888"\ncolours.{name}.odd = "{colour}"\n'
    first, second = map(str, unmet_goals(design(read(given), model)))
    assert "relax the weight of two under odd" in first
    assert "relax the weight of one under odd" in second


def test_the_objective_is_the_weighted_sum_of_all_criteria(metamers, model):
    """Eq. 18 and 20–22 written out for any spectra, with a light to be designed and
    goals of weights 7 and 0.
    """
    pairs = zip(metamers.goals, (1, 1, 7, 0), strict=True)
    goals = tuple(replace(goal, weight=weight) for goal, weight in pairs)
    lights = (*metamers.lights, SpectrumSpec("odd", None))
    paint = SpectrumSpec("paint", np.linspace(0.1, 0.9, 81))
    materials = (*metamers.materials, paint)
    palette = replace(
        metamers,
        lights=lights,
        materials=materials,
        goals=goals,
        smoothness=2.0,
        model_error=3.0,
    )
    where = unknowns(palette)
    problem = equations(palette, model)
    screen = screen_matrix(palette.sensor)
    x = np.random.default_rng(5).random(problem.matrix.shape[1])
    spectra = {}
    for kind, parts in (("light", lights), ("material", materials)):
        for part in parts:
            is_open = part.designed
            spectra[part.name] = x[where[kind, part.name]] if is_open else part.samples
    expected = 0.0
    for goal in goals:
        target = x[where["free", "coat"]] if goal.free else goal.rgb
        colour = screen @ (spectra[goal.material] * spectra[goal.light])
        expected += np.sum((goal.weight * (colour - target)) ** 2) / 3
    for name in ("odd", "fox", "moss"):
        bend = 2.0 * (SPACING / 5.0) ** 2 * np.diff(spectra[name], 2)
        expected += np.sum(bend**2) / (79 * 6)
    for material, light in product(materials, lights):
        if material.designed != light.designed:
            one, other = spectra[material.name], spectra[light.name]
            factors = model.light(other) * model.reflectance(one)
            wrong = screen @ (one * other) - model.rgb(factors)
            expected += 9.0 * wrong @ wrong / 3
    residual = problem.matrix @ x - problem.values
    assert residual @ residual == pytest.approx(expected, rel=1e-9)


@pytest.mark.filterwarnings("ignore:.*far from both:uplift.UpliftWarning")
def test_atlases_have_the_designed_materials_within_their_range(
    metamers, model, tmp_path
):
    designed = design(metamers, model)
    wild = replace(designed, reflectances=designed.reflectances - [[0.2], [0]])
    with warns("material-skipped"):
        assert write_designed(wild, tmp_path / "out.txt") == 1
    assert uplift.read_atlas(tmp_path / "out.txt").names == ("moss",)
    given = tuple(replace(part, samples=np.ones(81)) for part in metamers.materials)
    nothing = replace(designed, palette=replace(metamers, materials=given))
    with raises(PaletteError):
        write_designed(nothing, tmp_path / "new.txt")
