"""Mixtures by kind, and coats on grounds."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.common.errors import ColourError, OptionError, UpliftWarning
from uplift.design.mixing import coats, kubelka_munk, recipes, surface
from uplift.design.mixing.recipes import Ingredients, Medium, coat, mixed, ramp

WHITE = np.ones(5)
OIL, OVERCAST = surface.perpendicular(1.5), surface.overcast(1.5)


@pytest.fixture
def two(rng):
    """Two spectra, none darker than the surface of oil."""
    return Ingredients(rng.uniform(0.1, 0.9, (2, 5)), (None, None))


@pytest.mark.parametrize("kind", recipes.COATS)
@pytest.mark.parametrize(
    "medium", [Medium(), Medium(surface=OIL), Medium(surface=OVERCAST), Medium(grading=0)]
)
def test_one_colour_alone_is_itself(two, kind, medium):
    for parts, expected in (([1, 0], two.seen[0]), ([0, 3], two.seen[1])):
        np.testing.assert_allclose(mixed(kind, two, parts, medium, WHITE), expected, rtol=1e-9)


@pytest.mark.parametrize("kind", recipes.COATS)
@pytest.mark.parametrize("face", [surface.NONE, OIL, OVERCAST])
def test_no_thickness_leaves_the_ground(two, rng, kind, face):
    ground = rng.uniform(0.1, 1, 5)
    np.testing.assert_allclose(mixed(kind, two, [1, 1], Medium(0.0, face), ground), ground)


@pytest.mark.parametrize("face", [surface.NONE, OIL, OVERCAST])
def test_thick_paint_hides_any_ground(two, face):
    hiding = mixed("pigment", two, [1, 1], Medium(surface=face), 0.0)
    np.testing.assert_allclose(mixed("pigment", two, [1, 1], Medium(1e6, face), WHITE), hiding)


def test_paint_seen_on_white_and_black_is_seen_so_again(rng):
    layer = kubelka_munk.layer(coats.paint(rng.uniform(0.2, 0.8, 5)), 1.0)
    white, black = OIL.seen(layer.over(1.0)), OIL.seen(layer.over(0.0))
    given = Ingredients(white[None], (black,))
    for ground, expected in ((1.0, white), (0.04, black)):
        found = mixed("pigment", given, [2], Medium(1.0, OIL), ground)
        np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_filters_and_lights(two):
    np.testing.assert_allclose(mixed("filter", two, [2, 1], Medium(), 0.0), two.seen[0] ** 2 * two.seen[1])
    np.testing.assert_allclose(mixed("light", two, [2, 1], Medium(), 0.0), 2 * two.seen[0] + two.seen[1])


def test_many_proportions_at_once(two):
    parts = ramp([2, 1], 4)
    found = mixed("pigment", two, parts, Medium(0.5), WHITE)
    assert found.shape == (4, 5)
    np.testing.assert_allclose(found[1], mixed("pigment", two, parts[1], Medium(0.5), WHITE))


def test_ramps():
    np.testing.assert_allclose(ramp([2, 1], 3), [[2, 0], [1, 0.5], [0, 1]])
    np.testing.assert_allclose(ramp([1, 4, 1], 5)[:, 1], [0, 2, 4, 2, 0])
    assert ramp([1], 5).shape == (0, 1)
    with pytest.raises(OptionError, match="ramp of 1"):
        ramp([1, 1], 1)


@pytest.mark.parametrize(
    ("kind", "medium", "on_black", "problem"),
    [
        ("paint", Medium(), None, "unknown kind of mixture 'paint'"),
        ("filter", Medium(2.0), None, "have no thickness"),
        ("light", Medium(surface=OIL), None, "have no thickness"),
        ("light", Medium(), WHITE, "colour on black"),
        ("dye", Medium(), WHITE, "dyes have no colour on black"),
        ("dye", Medium(-1.0), None, "thickness -1.0"),
        ("pigment", Medium(float("inf")), None, "thickness inf"),
        ("pigment", Medium(grading=-1), None, "grading -1"),
    ],
)
def test_what_makes_no_sense_is_refused(two, kind, medium, on_black, problem):
    given = Ingredients(two.seen, (on_black, None))
    with pytest.raises(OptionError, match=problem):
        mixed(kind, given, [1, 1], medium, WHITE)


def test_what_is_darker_than_its_surface_is_told_of(two):
    dark = Ingredients(np.stack([two.seen[0], np.full(5, 0.03)]), (None, None))
    with pytest.warns(UpliftWarning, match="1 of 2 colours are in part darker than the surface"):
        found = mixed("pigment", dark, [0, 1], Medium(surface=OIL), WHITE)
    np.testing.assert_allclose(found, 0.04, atol=1e-4)


def test_lights_make_no_coat(two):
    with pytest.raises(OptionError, match="lights make no coat"):
        coat("light", two, [1, 1], Medium())


def test_paint_lighter_on_black_is_refused():
    with pytest.raises(ColourError, match="lighter on the darker"):
        coats.paint(np.full(5, 0.2), np.full(5, 0.5))
