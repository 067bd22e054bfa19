"""Properties of every representation."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.scene.representations import SIZES
from uplift.scene.representations.samples import xyz_weights

NAMES = [
    *(f"{family}{count}" for family in ("PS", "PF", "RS", "RE", "GQ") for count in SIZES),
    *("CS5", "CS7", "CS11", "CS15", "TM5", "TM9", "TM13", "TM17", "SG3", "LM4", "LM8", "LM16"),
    *("HW4", "HW16", "HW64", "HW256"),
]
EXACT = [name for name in NAMES if not name.startswith(("LM", "HW", "PF"))]
"""All but linear models of a scene, random hero wavelengths, and filters that count values past the ends as 0."""


def test_names_are_unique_and_registered(every):
    assert set(every) == set(NAMES)


@pytest.mark.parametrize("name", EXACT)
def test_grey_under_constant_light_is_exact(every, name):
    one = every[name]
    greys = np.array([[0.2], [0.5], [0.9]]) * np.ones(401)
    light = one.encode_light(np.full((3, 401), 2.0))
    actual = one.xyz(one.multiply(light, one.encode_surface(greys)))
    np.testing.assert_allclose(actual, 2 * greys @ xyz_weights(), rtol=2e-4)


@pytest.mark.parametrize("name", NAMES)
def test_colour_is_linear_in_the_light(every, checker, light_powers, name):
    one, surfaces = every[name], every[name].encode_surface(checker.surfaces)
    once, twice = (one.xyz(one.multiply(one.encode_light(k * light_powers("FL11")), surfaces)) for k in (1, 2))
    np.testing.assert_allclose(twice, 2 * once, rtol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_product_can_be_multiplied_again(every, checker, light_powers, name):
    one, surfaces = every[name], every[name].encode_surface(checker.surfaces)
    once = one.multiply(one.encode_light(light_powers("A")), surfaces)
    twice = one.xyz(one.multiply(once, surfaces))
    assert np.isfinite(twice).all()
    np.testing.assert_array_equal(one.storage(once) >= 3, True)
    dense = (light_powers("A") * checker.surfaces**2) @ xyz_weights()
    if name in ("PS32", "PF32", "RS32", "RE32", "GQ32", "TM17", "LM16"):
        np.testing.assert_allclose(twice, dense, atol=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_number_in_the_name_is_the_storage_of_a_smooth_spectrum(every, name):
    stored = every[name].storage(every[name].encode_surface(np.full((2, 401), 0.4)))
    count = int(name[2:])
    np.testing.assert_array_equal(stored, count**2 if name.startswith("LM") else count)


@pytest.mark.parametrize("family", ["PS", "PF", "RS", "GQ"])
def test_error_falls_with_size_under_smooth_light(every, checker, light_powers, family):
    dense = (light_powers("A") * checker.surfaces) @ xyz_weights()
    worst = []
    for count in SIZES:
        one = every[f"{family}{count}"]
        actual = one.xyz(one.multiply(one.encode_light(light_powers("A")), one.encode_surface(checker.surfaces)))
        worst.append(np.abs(actual - dense).max())
    assert worst == sorted(worst, reverse=True)
    assert worst[0] > 30 * worst[3]
