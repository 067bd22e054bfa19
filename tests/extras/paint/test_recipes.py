"""Recipes: known ones are found again, and no grid of parts has a better one."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.paint.invented import invented
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, delta_e_spectra, lab
from uplift.common.errors import OptionError
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment
from uplift.extras.paint.recipes import NEARLY, PaintTarget, match

GRID = (400, 700, 20)


@pytest.fixture(scope="module")
def paints():
    return invented()


def lights(*names):
    return tuple(
        observer.light(name, observer.DEFAULT_OBSERVER, *GRID) for name in names
    )


def target(reflectance, *names, **film):
    return PaintTarget(reflectance, lights(*names or ("D65",)), **film)


def parts_of(recipe):
    return dict(zip(recipe.paints, recipe.parts, strict=True))


@pytest.mark.parametrize(
    "parts",
    [
        {"yellow": 1},
        {"white": 50, "red": 1},
        {"white": 7, "yellow": 2, "blue": 1},
    ],
)
def test_known_recipes_are_found(paints, parts):
    amounts = [parts.get(name, 0) for name in paints.names]
    best, *others = match(target(paints.reflectance(amounts)), paints)
    assert best.error < NEARLY
    assert set(best.paints) == set(parts)
    found = parts_of(best)
    total = sum(best.parts) / sum(parts.values())
    for name, amount in parts.items():
        assert found[name] / total == pytest.approx(amount, rel=0.08)
    assert sum(best.parts) <= sum(parts.values())
    assert all(best.error <= other.error for other in others)


def test_recipes_are_whole_distinct_and_sorted(paints):
    goal = target(np.full(16, 0.3), "D65", "A", "FL11")
    recipes = match(goal, paints, count=3, steps=17, alternatives=8)
    assert len(recipes) == 8
    errors = [recipe.error for recipe in recipes]
    assert errors == sorted(errors)
    assert len({frozenset(recipe.paints) for recipe in recipes}) == 8
    for recipe in recipes:
        assert all(isinstance(part, int) and part > 0 for part in recipe.parts)
        assert list(recipe.parts) == sorted(recipe.parts, reverse=True)
        assert sum(recipe.parts) <= 17
        assert len(recipe.paints) <= 3
        amounts = [parts_of(recipe).get(name, 0) for name in paints.names]
        mixed = paints.reflectance(amounts)
        assert_allclose(recipe.reflectance, mixed)
        stated = [
            delta_e_spectra(light, mixed, goal.reflectance) for light in goal.lights
        ]
        assert_allclose(recipe.delta_e, stated)
        assert recipe.error == pytest.approx(np.mean(stated))


def best_of_grid(paints, goal):
    """Smallest ΔE00 of two paints over a fine grid of shares."""
    (light,) = goal.lights
    aim = lab(light.xyz @ goal.reflectance, light.white)
    shares = 1 / (1 + np.exp(np.linspace(-9, 9, 4001)))
    pairs = np.stack([shares, 1 - shares], axis=1)
    mixed = paints.reflectance(pairs, goal.thickness, goal.ground)
    return delta_e_2000(lab(mixed @ light.xyz.T, light.white), aim).min()


@pytest.mark.parametrize(
    "pair", [("white", "blue"), ("yellow", "blue"), ("red", "blue")]
)
def test_no_shares_of_two_paints_are_better(paints, pair):
    two = paints.select(pair)
    rng = np.random.default_rng(8)
    for film in ({}, {"thickness": 0.7, "ground": np.linspace(0.1, 0.8, 16)}):
        wanted = invented().reflectance(rng.dirichlet(np.ones(4), 3))
        for reflectance in wanted:
            goal = target(reflectance, **film)
            best = match(goal, two, count=2, steps=2000)[0]
            assert best.error <= best_of_grid(two, goal) + NEARLY + 1e-3


def test_films_on_a_ground(paints):
    ground = np.linspace(0.1, 0.8, 16)
    film = {"thickness": 0.4, "ground": ground}
    reflectance = paints.reflectance([0, 3, 1, 0], **film)
    best = match(target(reflectance, **film), paints)[0]
    assert parts_of(best) == {"yellow": 3, "red": 1}


def test_colours_out_of_reach_get_the_nearest(paints):
    """A green brighter than any mixture: no better one has fewer paints."""
    nm = paints.wavelengths
    green = np.exp(-(((nm - 530) / 25) ** 2))
    three = match(target(green), paints, count=3)
    two = match(target(green), paints, count=2)
    assert 5 < three[0].error <= two[0].error + NEARLY
    assert {"yellow", "blue"} <= set(two[0].paints)
    for level in (0.0, 1.0):
        assert np.isfinite(match(target(np.full(16, level)), paints)[0].error)


def test_metamers_agree_under_all_lights_that_count(paints):
    """Under two lights the mean error is at most that of the recipe for one."""
    nm = paints.wavelengths
    wanted = 0.25 + 0.15 * np.sin(nm / 25)
    one = match(target(wanted), paints, count=4)[0]
    both = match(target(wanted, "D65", "A"), paints, count=4)[0]
    errors = [
        delta_e_spectra(light, one.reflectance, wanted) for light in lights("D65", "A")
    ]
    assert both.error <= np.mean(errors) + NEARLY


def test_few_parts_suffice(paints):
    goal = target(paints.reflectance([13, 7, 0, 3]))
    errors = [match(goal, paints, steps=steps)[0].error for steps in (1, 5, 23, 100)]
    assert (np.diff(errors) <= NEARLY).all()
    assert sum(match(goal, paints, steps=1)[0].parts) == 1
    assert errors[2] < NEARLY


def test_one_paint_and_sets_larger_than_the_choice(paints):
    alone = match(target(np.full(16, 0.5)), paints.select(["red"]), count=5)
    assert [recipe.paints for recipe in alone] == [("red",)]
    assert alone[0].parts == (1,)


@pytest.mark.parametrize(
    ("code", "options"),
    [
        ("option", {"count": 0}),
        ("option", {"steps": 10_001}),
        ("option", {"alternatives": 0}),
        ("too-many-recipes", {"count": 3}),
    ],
)
def test_options_out_of_range_raise(code, options):
    pigments = Pigment(*np.ones((2, 70, 16)))
    many = Paints(tuple(map(str, range(70))), invented().wavelengths, pigments)
    with raises(OptionError, code):
        match(target(np.full(16, 0.5)), many, **options)
