"""Recipes: known ones are found again, and no grid of parts has a better one."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.paint.invented import invented
from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.common.errors import OptionError
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment
from uplift.extras.paint.recipes import NEARLY, PaintTarget, match

GROUND = np.linspace(0.1, 0.8, 16)


PAINTS = invented()


def target(reflectance, *names, **film):
    """A target under lights, D65 by default."""
    lights = tuple(map(PAINTS.light, names or ("D65",)))
    return PaintTarget(reflectance, lights, **film)


def amounts_of(recipe):
    """Parts of all paints."""
    parts = dict(zip(recipe.paints, recipe.parts, strict=True))
    return [parts.get(name, 0) for name in PAINTS.names]


@pytest.mark.parametrize("parts", [[0, 1, 0, 0], [50, 0, 1, 0], [7, 2, 0, 1]])
@pytest.mark.parametrize("film", [{}, {"thickness": 0.4, "ground": GROUND}])
def test_known_recipes_are_found(parts, film):
    best, *others = match(target(PAINTS.reflectance(parts, **film), **film), PAINTS)
    assert best.error < NEARLY
    assert all(best.error <= other.error for other in others)
    found = np.array(amounts_of(best))
    assert_allclose(found / found.sum(), np.divide(parts, sum(parts)), rtol=0.12)
    assert found.sum() <= sum(parts)


def test_recipes_are_whole_distinct_and_sorted():
    goal = target(np.full(16, 0.3), "D65", "A", "FL11")
    recipes = match(goal, PAINTS, count=3, steps=17, alternatives=8)
    assert len(recipes) == 8
    errors = [recipe.error for recipe in recipes]
    assert errors == sorted(errors)
    assert len({frozenset(recipe.paints) for recipe in recipes}) == 8
    for recipe in recipes:
        assert all(isinstance(part, int) for part in recipe.parts)
        assert list(recipe.parts) == sorted(recipe.parts, reverse=True)
        assert sum(recipe.parts) <= 17
        assert len(recipe.paints) <= 3
        mixed = PAINTS.reflectance(amounts_of(recipe))
        assert_allclose(recipe.reflectance, mixed)
        stated = delta_e_spectra(goal.lights[1], mixed, goal.reflectance)
        assert recipe.delta_e[1] == pytest.approx(stated)
        assert recipe.error == pytest.approx(np.mean(recipe.delta_e))


GREEN = np.exp(-(((PAINTS.wavelengths - 530) / 25) ** 2))
"""Brighter than any mixture."""
GOALS = [
    target(GREEN),
    target(np.zeros(16)),
    target(np.ones(16)),
    target(0.25 + 0.15 * np.sin(np.arange(16) / 1.25), "D65", "A"),
    target(np.full(16, 0.3), thickness=0.7, ground=GROUND),
]


@pytest.mark.parametrize("goal", GOALS)
@pytest.mark.parametrize("pair", [("white", "blue"), ("yellow", "blue")])
def test_no_shares_of_two_paints_are_better(goal, pair):
    """The mean ΔE00 under the lights, over a fine grid of shares."""
    two = PAINTS.select(pair)
    shares = 1 / (1 + np.exp(np.linspace(-9, 9, 4001)))
    mixed = two.reflectance(
        np.stack([shares, 1 - shares], axis=1), goal.thickness, goal.ground
    )
    errors = [
        delta_e_spectra(light, mixed, goal.reflectance[None]) for light in goal.lights
    ]
    best = np.mean(errors, axis=0).min()
    found = match(goal, two, count=2, steps=10_000)[0]
    assert found.error <= 1.01 * best + NEARLY


@pytest.mark.parametrize(
    ("code", "options"),
    [
        ("option", {"count": 0}),
        ("option", {"steps": 10_001}),
        ("too-many-recipes", {"count": 3}),
    ],
)
def test_options_out_of_range_raise(code, options):
    pigments = Pigment(*np.ones((2, 70, 16)))
    many = Paints(tuple(map(str, range(70))), PAINTS.wavelengths, pigments)
    with raises(OptionError, code):
        match(target(GREEN), many, **options)
