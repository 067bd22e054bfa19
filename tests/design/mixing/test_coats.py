"""Mixtures by kind of component, and coats on grounds."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises, warns
from uplift.common.errors import ColourError, OptionError
from uplift.design.mixing import Ingredients, Medium, Surface, make_coat, mix
from uplift.design.mixing.coats import COATS, DARKEST, dye_absorption, dye_transmittance, ramp
from uplift.design.mixing.layers import NO_SURFACE, Layer
from uplift.design.mixing.pigments import CONSTANT, SQUARE_ROOT, from_opaque

WHITE = np.ones(5)
PLAIN = Medium(scattering=SQUARE_ROOT)
OIL, DIFFUSE = Surface.of_index(1.5), Surface.of_index(1.5, "diffuse")
T = np.array([0.0, 0.05, 0.5, 0.9, 1.0])


@pytest.fixture
def two(rng):
    """Two spectra, not darker than the surface of oil."""
    return Ingredients(rng.uniform(0.1, 0.9, (2, 5)))


@pytest.mark.parametrize("kind", COATS)
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


@pytest.mark.parametrize("kind", COATS)
@pytest.mark.parametrize("surface", [NO_SURFACE, OIL, DIFFUSE])
def test_thickness_0_leaves_the_ground(two, rng, kind, surface):
    ground = rng.uniform(0.1, 1, 5)
    np.testing.assert_allclose(mix(kind, two, [1, 1], Medium(0.0, surface, SQUARE_ROOT), ground), ground)


@pytest.mark.parametrize("surface", [NO_SURFACE, OIL, DIFFUSE])
def test_thick_paint_hides_the_ground(two, surface):
    opaque = mix("pigment", two, [1, 1], Medium(surface=surface, scattering=SQUARE_ROOT), 0.0)
    np.testing.assert_allclose(mix("pigment", two, [1, 1], Medium(1e6, surface, SQUARE_ROOT), WHITE), opaque)


def test_paint_measured_on_white_and_black_round_trip(rng):
    layer = from_opaque(rng.uniform(0.2, 0.8, 5), SQUARE_ROOT).layer(1.0)
    white, black = OIL.apply(layer.over(1.0)), OIL.apply(layer.over(0.0))
    for ground, expected in ((1.0, white), (0.04, black)):
        found = mix("pigment", Ingredients(white[None], (black,)), [2], Medium(1.0, OIL), ground)
        np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_filters_and_lights(two):
    np.testing.assert_allclose(mix("filter", two, [2, 1], PLAIN, 0.0), two.spectra[0] ** 2 * two.spectra[1])
    np.testing.assert_allclose(mix("light", two, [2, 1], PLAIN, 0.0), 2 * two.spectra[0] + two.spectra[1])


def test_the_thesis_s_filters():
    """9.2.1.2: cyan light through an orange and a grey filter."""
    filters = Ingredients(np.array([[0, 1, 1], [1, 0.5, 0], [0.5, 0.5, 0.5]]))
    np.testing.assert_allclose(mix("filter", filters, [1, 1, 1], Medium(), 0.0), [0, 0.25, 0])


def test_many_proportions_at_once(two):
    parts = ramp([2, 1], 4)
    found = mix("pigment", two, parts, Medium(0.5, scattering=SQUARE_ROOT), WHITE)
    assert found.shape == (4, 5)
    np.testing.assert_allclose(found[1], mix("pigment", two, parts[1], Medium(0.5, scattering=SQUARE_ROOT), WHITE))


def test_ramps():
    np.testing.assert_allclose(ramp([1, 4, 1], 5)[:, 1], [0, 2, 4, 2, 0])
    assert ramp([1], 5).shape == (0, 1)
    with pytest.raises(OptionError):
        ramp([1, 1], 1)


@pytest.mark.parametrize(
    ("kind", "medium", "on_black", "code"),
    [
        ("paint", PLAIN, None, "option"),
        ("filter", Medium(2.0), None, "option"),
        ("light", Medium(surface=OIL, scattering=SQUARE_ROOT), None, "option"),
        ("light", PLAIN, WHITE, "option"),
        ("dye", PLAIN, WHITE, "option"),
        ("dye", Medium(-1.0), None, "invalid-thickness"),
        ("pigment", Medium(float("inf"), scattering=SQUARE_ROOT), None, "invalid-thickness"),
        ("pigment", Medium(), None, "option"),
    ],
)
def test_inapplicable_settings_raise(two, kind, medium, on_black, code):
    with raises(OptionError, code):
        mix(kind, Ingredients(two.spectra, (on_black, None)), [1, 1], medium, WHITE)


@pytest.mark.parametrize("parts", [[1, -1], [1, np.nan], [1, np.inf], 3.0, [0, 0]])
def test_invalid_parts_raise(two, parts):
    with pytest.raises(OptionError):
        mix("dye", two, parts, PLAIN, WHITE)


def test_colours_darker_than_the_surface_trigger_a_warning(two):
    dark = Ingredients(np.stack([two.spectra[0], np.full(5, 0.03)]))
    with warns("warning") as caught:
        found = mix("pigment", dark, [0, 1], Medium(surface=OIL, scattering=SQUARE_ROOT), WHITE)
    assert caught[0].problem.startswith("1 of 2 colours ")
    np.testing.assert_allclose(found, 0.04, atol=1e-4)


def test_impossible_coats_raise(two):
    with raises(OptionError, "unknown-coat"):
        make_coat("light", two, [1, 1], PLAIN)
    with pytest.raises(ColourError):
        make_coat("pigment", Ingredients(np.full((1, 5), 0.2), (np.full(5, 0.5),)), [1], PLAIN)


def rays_in_contact(transmittance, ground, surface):
    """Sum the light that leaves a dye on a ground at each pass (9.6)."""
    light, total = (1 - surface.outside) * np.ones_like(transmittance), surface.outside
    for _ in range(500):
        light = light * transmittance * ground * transmittance
        total, light = total + (1 - surface.inside) * light, surface.inside * light
    return total


def on_ground(transmittance, ground, surface):
    return surface.apply(Layer(np.zeros_like(transmittance), transmittance).over(ground))


@pytest.mark.parametrize("ground", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("surface", [OIL, DIFFUSE, Surface(0.04, 0.04), NO_SURFACE])
def test_a_dye_on_a_ground_is_the_sum_over_passes(surface, ground):
    expected = rays_in_contact(T, ground, surface)
    np.testing.assert_allclose(on_ground(T, ground, surface), expected, atol=1e-12)


def test_thicknesses_of_dyes_compose_and_black_is_finite():
    K = np.array([0.2, 3])
    np.testing.assert_allclose(dye_transmittance(K, 5), dye_transmittance(K, 2) * dye_transmittance(K, 3))
    np.testing.assert_allclose(dye_transmittance(dye_absorption(T**2), 1), np.maximum(T, DARKEST))
