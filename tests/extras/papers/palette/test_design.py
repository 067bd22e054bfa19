"""Designs: bounds, optimality, missed goals, rows of the equations against their
criteria, atlases and plots.
"""

import dataclasses
import itertools
from itertools import product

import numpy as np
import pytest
from matplotlib.image import imread
from numpy.testing import assert_allclose

import uplift
from tests.helpers import raises, warns
from uplift.common.errors import OutputError, PaletteError
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.papers.palette.colours import illuminant, screen_matrix
from uplift.extras.papers.palette.design import design, matrix, write_designed
from uplift.extras.papers.palette.equations import SPACING, equations, solve, unknowns
from uplift.extras.papers.palette.palette import ColourGoal, Palette, SpectrumSpec
from uplift.extras.papers.palette.plots import plot_matrix
from uplift.extras.papers.palette.spec import read_palette
from uplift.extras.papers.palette.unmet import unmet_goals

BLACK = np.zeros(3)


@pytest.fixture(scope="module")
def found(metamers, model):
    return design(metamers, model)


def test_spectra_and_free_colours_stay_within_their_bounds(found, metamers, model):
    assert found.reflectances.min() >= -1e-9
    assert found.reflectances.max() <= 1 + 1e-9
    tight = tuple(
        dataclasses.replace(part, low=0.1, high=0.6) for part in metamers.materials
    )
    low = np.array([0.05, 0.2, 0.1])
    high = np.array([0.2, 0.3, 0.15])
    narrow = design(
        dataclasses.replace(metamers, materials=tight, free={"coat": (low, high)}),
        model,
    )
    assert narrow.reflectances.min() >= 0.1 - 1e-9
    assert narrow.reflectances.max() <= 0.6 + 1e-9
    assert (
        (narrow.free["coat"] >= low - 1e-9) & (narrow.free["coat"] <= high + 1e-9)
    ).all()


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
    """Up to three given lights and three open materials with goals that may contradict
    one another.
    """
    names = draw.choice(
        ["D65", "A", "FL2", "FL11", "LED-RGB1", "HP1"],
        draw.integers(1, 4),
        replace=False,
    )
    lights = tuple(
        SpectrumSpec(str(name), illuminant(sensor, str(name))) for name in names
    )
    materials = tuple(
        SpectrumSpec(f"m{row}", None) for row in range(draw.integers(1, 4))
    )
    goals = []
    for material, light in itertools.product(materials, lights):
        aim = {"free": "x"} if draw.random() < 0.3 else {"rgb": draw.random(3)}
        goals.append(ColourGoal(material.name, light.name, **aim))
    weights = {
        "smoothness": float(draw.choice([0, 1e-3])),
        "model_error": float(draw.choice([0, 0.1, 1])),
    }
    return Palette(
        sensor, lights, materials, tuple(goals), {"x": (BLACK, np.ones(3))}, **weights
    )


def of_light(metamers, samples, rgb, **settings):
    """The palette of a light to be designed for the colours of given materials."""
    return dataclasses.replace(
        metamers,
        lights=(SpectrumSpec("odd", None, 0.0, np.inf),),
        materials=tuple(
            SpectrumSpec(str(row), each) for row, each in enumerate(samples)
        ),
        goals=tuple(
            ColourGoal(str(row), "odd", rgb=each) for row, each in enumerate(rgb)
        ),
        free={},
        **settings,
    )


def test_a_goal_with_open_light_and_material_is_refused(metamers, model):
    lights = (SpectrumSpec("day", None, 0.0, np.inf), metamers.lights[1])
    with pytest.raises(PaletteError) as caught:
        design(dataclasses.replace(metamers, lights=lights), model)
    assert "fox under day" in caught.value.problem


def test_colours_of_the_factor_model_can_be_fitted(metamers, model):
    """Equation 19: the goals hold in the factor model, and no longer in
    full spectra.
    """
    weights = {"model_error": 0.0, "smoothness": 0.0}
    found = design(dataclasses.replace(metamers, fit="factor-model", **weights), model)
    target = np.array([found.free["coat"], found.free["coat"]])
    assert_allclose(matrix(found).factor[:, 0], target, atol=1e-6)
    assert matrix(found).delta_e.max() < 0.01
    assert np.abs(matrix(found).obtained[:, 0] - target).max() > 1e-4


@pytest.fixture
def black(metamers):
    """A paint that reflects at least 10 %, with the goals of grey by day and black
    under the lamp.
    """
    goals = (
        ColourGoal("soot", "day", rgb=np.full(3, 0.2)),
        ColourGoal("soot", "lamp", rgb=np.zeros(3)),
    )
    return dataclasses.replace(
        metamers, materials=(SpectrumSpec("soot", None, 0.1, 1),), goals=goals, free={}
    )


def test_the_relaxation_suggested_for_a_missed_goal_meets_it(black, model):
    """Without bounds the goal is met with the reported ΔE00."""
    (lamp,) = (
        each
        for each in unmet_goals(design(black, model))
        if each.goal is black.goals[1]
    )
    assert lamp.delta_e > 10
    assert dict(lamp.relaxations)["the bounds of soot"] < 0.5
    wide = dataclasses.replace(
        black, materials=(SpectrumSpec("soot", None, -np.inf, np.inf),)
    )
    assert not unmet_goals(design(wide, model))


def test_contradicting_goals_name_one_another(metamers, model):
    """One spectrum under one light cannot have two colours."""
    palette = of_light(
        metamers, [np.full(81, 0.4)] * 2, [np.full(3, 0.3), np.array([0.1, 0.3, 0.3])]
    )
    texts = [str(each) for each in unmet_goals(design(palette, model))]
    assert [
        "relax the weight of 1 under odd" in texts[0],
        "relax the weight of 0 under odd" in texts[1],
    ] == [True] * 2


DAY = 'lights.day.illuminant = "D65"\n'
GIVEN = 'materials.grey.rgb = "#808080"\n'
NEW = "materials.new.design = true\n"


@pytest.mark.parametrize(
    "text",
    [
        DAY + GIVEN,
        "smoothness = 0\nmodel-error = 0\n"
        + DAY
        + "materials.new = { design = true, bounds = false }",
        "lights.odd.design = true\n" + NEW,
        DAY + NEW + 'colours.new.day = { free = "alone" }',
        DAY + NEW + 'colours.new.day = { rgb = "#ff0000", weight = 1000000 }',
        'lights.off = { illuminant = "D65", luminance = 0 }\n'
        + NEW
        + 'colours.new.off = "#000000"',
    ],
)
def test_all_results_are_finite(model, tmp_path, text):
    (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
    found = design(read_palette(tmp_path / "spec.toml"), model)
    colours = matrix(found)
    for numbers in (
        found.powers,
        found.reflectances,
        colours.obtained,
        colours.factor,
        colours.model_error,
    ):
        assert np.isfinite(numbers).all()
    assert unmet_goals(found) == ()


def test_the_objective_is_the_weighted_sum_of_all_criteria(metamers, model):
    """Eq. 18 and 20–22 written out for any spectra, with a light to be designed and
    goals of weights 7 and 0.
    """
    pairs = zip(metamers.goals, (1, 1, 7, 0), strict=True)
    goals = tuple(dataclasses.replace(goal, weight=weight) for goal, weight in pairs)
    paint = SpectrumSpec("paint", np.linspace(0.1, 0.9, 81))
    odd = SpectrumSpec("odd", None)
    lights = (*metamers.lights, odd)
    materials = (*metamers.materials, paint)
    weights = {"smoothness": 2.0, "model_error": 3.0}
    palette = dataclasses.replace(
        metamers, lights=lights, materials=materials, goals=goals, **weights
    )
    where = unknowns(palette)
    problem = equations(palette, model)
    screen = screen_matrix(palette.sensor)
    x = np.random.default_rng(5).random(problem.matrix.shape[1])
    power = {
        each.name: x[where["light", "odd"]] if each.designed else each.samples
        for each in lights
    }
    surface = {
        each.name: x[where["material", each.name]] if each.designed else each.samples
        for each in materials
    }
    expected = 0.0
    for goal in goals:
        target = x[where["free", "coat"]] if goal.free else goal.rgb
        wrong = screen @ (surface[goal.material] * power[goal.light]) - target
        expected += (goal.weight * wrong) @ (goal.weight * wrong) / 3
    for spectrum in (power["odd"], surface["fox"], surface["moss"]):
        expected += np.sum((2.0 * (SPACING / 5.0) ** 2 * np.diff(spectrum, 2)) ** 2) / (
            79 * 6
        )
    for material, light in product(materials, lights):
        if material.designed != light.designed:
            one = surface[material.name]
            other = power[light.name]
            wrong = screen @ (one * other) - model.rgb(
                model.light(other) * model.reflectance(one)
            )
            expected += 9.0 * wrong @ wrong / 3
    assert np.sum((problem.matrix @ x - problem.values) ** 2) == pytest.approx(
        expected, rel=1e-9
    )


@pytest.fixture(scope="module")
def designed(metamers, model):
    given = SpectrumSpec("given", np.full(81, 0.5))
    return design(
        dataclasses.replace(metamers, materials=(*metamers.materials, given)), model
    )


def test_materials_outside_the_range_of_atlases_are_left_out(designed, tmp_path):
    wild = dataclasses.replace(
        designed, reflectances=designed.reflectances - [[0.2], [0], [0]]
    )
    with warns("material-skipped"):
        assert write_designed(wild, tmp_path / "out.txt") == 1
    assert uplift.read_atlas(tmp_path / "out.txt").names == ("moss",)


def test_an_empty_atlas_is_refused_and_a_file_is_kept_without_force(designed, tmp_path):
    (tmp_path / "out.txt").write_text("mine", encoding="utf-8")
    with raises(OutputError, "file-exists"):
        write_designed(designed, tmp_path / "out.txt")
    given = tuple(
        dataclasses.replace(part, samples=np.ones(81))
        for part in designed.palette.materials
    )
    nothing = dataclasses.replace(
        designed, palette=dataclasses.replace(designed.palette, materials=given)
    )
    with raises(PaletteError):
        write_designed(nothing, tmp_path / "new.txt")


def test_the_matrix_shows_every_colour(designed, tmp_path):
    """Target, obtained and modelled colours are pixels of the PNG."""
    colours = matrix(designed)
    split = dataclasses.replace(
        colours, target=colours.target * 0.5, factor=colours.factor * 0.8
    )
    plot_matrix(designed, split, tmp_path / "m.png")
    pixels = np.rint(255 * imread(tmp_path / "m.png")[..., :3]).astype(np.uint8)
    drawn = {bytes(pixel) for pixel in np.unique(pixels.reshape(-1, 3), axis=0)}
    for kind in (split.target[:2], split.obtained, split.factor):
        for code in hex_codes(kind.reshape(-1, 3)):
            assert bytes.fromhex(code[1:]) in drawn
