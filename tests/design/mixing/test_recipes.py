"""Mixtures by kind of component, and coats on grounds."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises, warns
from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing import coats, kubelka_munk, recipes, surface
from uplift.design.mixing.recipes import Ingredients, Medium, make_coat, mix, ramp
from uplift.design.mixing.scattering import CONSTANT, SQUARE_ROOT

WHITE = np.ones(5)
PLAIN = Medium(scattering=SQUARE_ROOT)
OIL, DIFFUSE = surface.normal_incidence(1.5), surface.diffuse_incidence(1.5)


@pytest.fixture
def two(rng):
    """Two spectra, not darker than the surface of oil."""
    return Ingredients(rng.uniform(0.1, 0.9, (2, 5)), (None, None))


@pytest.mark.parametrize("kind", recipes.COATS)
@pytest.mark.parametrize(
    "medium",
    [
        PLAIN,
        Medium(surface=OIL, scattering=SQUARE_ROOT),
        Medium(surface=DIFFUSE, scattering=SQUARE_ROOT),
        Medium(scattering=CONSTANT),
    ],
)
def test_a_single_colour_is_unchanged(two, kind, medium):
    for parts, expected in (([1, 0], two.spectra[0]), ([0, 3], two.spectra[1])):
        np.testing.assert_allclose(mix(kind, two, parts, medium, WHITE), expected, rtol=1e-9)


@pytest.mark.parametrize("kind", recipes.COATS)
@pytest.mark.parametrize("face", [surface.NO_SURFACE, OIL, DIFFUSE])
def test_thickness_0_leaves_the_ground(two, rng, kind, face):
    ground = rng.uniform(0.1, 1, 5)
    np.testing.assert_allclose(mix(kind, two, [1, 1], Medium(0.0, face, SQUARE_ROOT), ground), ground)


@pytest.mark.parametrize("face", [surface.NO_SURFACE, OIL, DIFFUSE])
def test_thick_paint_hides_the_ground(two, face):
    opaque = mix("pigment", two, [1, 1], Medium(surface=face, scattering=SQUARE_ROOT), 0.0)
    np.testing.assert_allclose(mix("pigment", two, [1, 1], Medium(1e6, face, SQUARE_ROOT), WHITE), opaque)


def test_paint_measured_on_white_and_black_round_trip(rng):
    layer = kubelka_munk.layer(coats.pigment_from_reflectance(rng.uniform(0.2, 0.8, 5), SQUARE_ROOT), 1.0)
    white, black = OIL.apply(layer.over(1.0)), OIL.apply(layer.over(0.0))
    ingredients = Ingredients(white[None], (black,))
    for ground, expected in ((1.0, white), (0.04, black)):
        found = mix("pigment", ingredients, [2], Medium(1.0, OIL), ground)
        np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_filters_and_lights(two):
    np.testing.assert_allclose(mix("filter", two, [2, 1], PLAIN, 0.0), two.spectra[0] ** 2 * two.spectra[1])
    np.testing.assert_allclose(mix("light", two, [2, 1], PLAIN, 0.0), 2 * two.spectra[0] + two.spectra[1])


def test_many_proportions_at_once(two):
    parts = ramp([2, 1], 4)
    found = mix("pigment", two, parts, Medium(0.5, scattering=SQUARE_ROOT), WHITE)
    assert found.shape == (4, 5)
    np.testing.assert_allclose(found[1], mix("pigment", two, parts[1], Medium(0.5, scattering=SQUARE_ROOT), WHITE))


def test_ramps():
    np.testing.assert_allclose(ramp([2, 1], 3), [[2, 0], [1, 0.5], [0, 1]])
    np.testing.assert_allclose(ramp([1, 4, 1], 5)[:, 1], [0, 2, 4, 2, 0])
    assert ramp([1], 5).shape == (0, 1)
    with raises(OptionError, "too-few-steps"):
        ramp([1, 1], 1)


@pytest.mark.parametrize(
    ("kind", "medium", "on_black", "code"),
    [
        ("paint", PLAIN, None, "unknown-mixture"),
        ("filter", Medium(2.0), None, "medium-not-applicable"),
        ("light", Medium(surface=OIL, scattering=SQUARE_ROOT), None, "medium-not-applicable"),
        ("light", PLAIN, WHITE, "medium-not-applicable"),
        ("dye", PLAIN, WHITE, "dye-on-black"),
        ("dye", Medium(-1.0), None, "invalid-thickness"),
        ("pigment", Medium(float("inf"), scattering=SQUARE_ROOT), None, "invalid-thickness"),
        ("pigment", Medium(), None, "scattering-missing"),
    ],
)
def test_inapplicable_settings_raise(two, kind, medium, on_black, code):
    ingredients = Ingredients(two.spectra, (on_black, None))
    with raises(OptionError, code):
        mix(kind, ingredients, [1, 1], medium, WHITE)


def test_colours_darker_than_the_surface_trigger_a_warning(two):
    dark = Ingredients(np.stack([two.spectra[0], np.full(5, 0.03)]), (None, None))
    with warns("darker-than-surface") as caught:
        found = mix("pigment", dark, [0, 1], Medium(surface=OIL, scattering=SQUARE_ROOT), WHITE)
    assert caught[0].problem.startswith("1 of 2 colours ")
    np.testing.assert_allclose(found, 0.04, atol=1e-4)


def test_a_coat_of_lights_raises(two):
    with raises(OptionError, "unknown-coat"):
        make_coat("light", two, [1, 1], PLAIN)


def test_paint_lighter_on_black_raises():
    with raises(ColourError, "layer-too-opaque"):
        coats.pigment_from_two_grounds(np.full(5, 0.2), np.full(5, 0.5))
