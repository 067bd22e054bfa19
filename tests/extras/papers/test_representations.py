"""Representations: laws of all of them, and each against direct computations or its
paper.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from tests.conftest import MACBETH
from tests.helpers import raises
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.errors import OptionError
from uplift.extras.papers.representations.compare import make_scene
from uplift.extras.papers.representations.composite import (
    enhanced_riemann,
    fourier_coefficients,
    split_spikes,
    sun_composite,
)
from uplift.extras.papers.representations.filters import Filter, resampling_matrix
from uplift.extras.papers.representations.models import (
    hero_wavelengths,
)
from uplift.extras.papers.representations.registry import (
    all_representations,
    find_representation,
)
from uplift.extras.papers.representations.samples import (
    hat_functions,
    xyz_weights,
)
from uplift.extras.scene.passes.representation import rgb_passes


@pytest.fixture(scope="module")
def checker():
    return make_scene({"macbeth": read_atlas(MACBETH)})


@pytest.fixture(scope="module")
def every(checker):
    """Every representation by name."""
    return {
        one.name: one for one in all_representations(checker.powers, checker.surfaces)
    }


NAMES = [
    *("PS4", "PS32", "PF4", "PF32", "RS4", "RS32", "RE4", "RE32", "GQ4", "GQ32"),
    *("CS5", "CS15", "TM5", "TM17", "SG3", "LM4", "LM16", "HW4", "HW256"),
]
EXACT = [name for name in NAMES if not name.startswith(("LM", "HW", "PF"))]
"""All but linear models of a scene, random hero wavelengths, and filters that count
values past the ends as 0.
"""
ACCURATE = ("PS32", "PF32", "RS32", "RE32", "GQ32", "TM17", "LM16")


@pytest.mark.parametrize("name", EXACT)
def test_grey_under_constant_light_is_exact(every, name):
    one = every[name]
    greys = np.array([[0.2], [0.5], [0.9]]) * np.ones(401)
    light = one.encode_light(np.full((3, 401), 2.0))
    actual = one.xyz(one.multiply(light, one.encode_surface(greys)))
    assert_allclose(actual, 2 * greys @ xyz_weights(), rtol=2e-4)


@pytest.mark.parametrize("name", NAMES)
def test_colour_is_linear_in_the_light_and_products_can_be_multiplied_again(
    every, checker, name
):
    one = every[name]
    surfaces = one.encode_surface(checker.surfaces)
    smooth, spiky = (np.tile(part.powers[0], (24, 1)) for part in checker.sets)
    once = one.multiply(one.encode_light(spiky), surfaces)
    twice = one.multiply(one.encode_light(2 * spiky), surfaces)
    assert_allclose(one.xyz(twice), 2 * one.xyz(once), rtol=1e-9)
    lit = one.multiply(one.encode_light(smooth), surfaces)
    again = one.xyz(one.multiply(lit, surfaces))
    assert np.isfinite(again).all()
    if name in ACCURATE:
        exact = (smooth * checker.surfaces**2) @ xyz_weights()
        assert_allclose(again, exact, atol=0.01)


@pytest.mark.parametrize(("count", "limit"), [(3, 6), (6, 1.5), (9, 0.5), (12, 0.3)])
def test_passes_of_rgb_are_near_to_spectra(checker, count, limit):
    passes = rgb_passes(count)
    for lights in checker.sets:
        xyz = passes.reflected(lights.powers, lights.reflectances)
        errors = delta_e_2000(lights.to_lab(xyz), lights.lab)
        assert errors.mean() < limit
    assert passes.numbers(checker.powers, checker.surfaces) == (count, count)


UNKNOWN = """XX4 SG5 TM18 PS PS1 PS999 PS16:gaussian:7:nan RS16:box:3 PS16:box:4
PS16:box:3:1 PS16:cone:3 RP2 RP4 RP15"""


@pytest.mark.parametrize("name", UNKNOWN.split())
def test_unknown_representations_raise(name):
    with raises(OptionError, "option"):
        find_representation(name)


SOME = [
    Filter("box", 5),
    Filter("gaussian", 7, (0.5,)),
    Filter("mitchell", 19, (-0.4, 1.0)),
    Filter("hann", 9),
]


def reference_conversion(taps, up, down, count, spectrum):
    """Conversion as in the listing of the thesis: insert zeros, filter, keep every M-th
    sample.
    """
    dense = np.zeros((len(spectrum) - 1) * up + 1)
    dense[::up] = spectrum
    smoothed = np.convolve(dense, taps * up, mode="full")[len(taps) // 2 :]
    return smoothed[: (count - 1) * down + 1 : down]


@pytest.mark.parametrize("low_pass", SOME, ids=lambda one: one.kind)
@pytest.mark.parametrize(("count", "up", "down"), [(4, 3, 80), (8, 7, 80), (16, 3, 16)])
def test_resampling_equals_the_listing_of_the_thesis(low_pass, count, up, down):
    spectrum = np.random.default_rng(8).random(81)
    expected = reference_conversion(low_pass.taps(up), up, down, count, spectrum)
    assert_allclose(resampling_matrix(low_pass, count) @ spectrum, expected, atol=1e-12)


TABLES = arrays(float, (2, 81), elements=st.floats(0, 100, width=32))


def dense(table):
    return table @ hat_functions(observer.grid())


@settings(max_examples=15)
@given(TABLES, st.sampled_from([0.1, 0.2, 0.3]))
def test_smooth_part_is_the_largest_with_limited_gradient(table, threshold):
    found = split_spikes(dense(table), threshold)
    rest = found.smooth
    distance = np.abs(np.arange(81)[:, None] - np.arange(81))
    steepest = threshold * table.max(axis=1)[:, None, None]
    oracle = (table[:, None, :] + steepest * distance).min(axis=2)
    scale = max(table.max(), 1)
    assert_allclose(rest[:, ::5], oracle, atol=2e-9 * scale)
    whole = rest[:, ::5].copy()
    whole[:, found.positions] += found.heights
    assert_allclose(whole, table, atol=1e-12 * scale)
    assert (found.heights >= 0).all()


@pytest.mark.parametrize("count", [1, 5, 15])
def test_fourier_coefficients_equal_equation_4_7(count):
    table = np.random.default_rng(6).random((2, 81))
    actual = fourier_coefficients(count).encode_light(dense(table))
    table[:, 80] = (table[:, 0] + table[:, 80]) / 2
    phase = np.arange(1, 81) * 2 * np.pi / 80
    expected = [table[:, 1:].mean(axis=1)]  # ã_0 / 2 of eq. 4.7
    for order in range(1, count // 2 + 1):
        for wave in (np.cos, np.sin):
            expected.append((table[:, 1:] @ wave(order * phase)) * 2 / 80)
    assert_allclose(actual, np.transpose(expected), atol=1e-12)


@pytest.mark.parametrize("make", [sun_composite, enhanced_riemann])
def test_spikes_multiply_exactly_on_constant_spectra(make):
    one = make(7, threshold=1e-9)  # all of a spike belongs to the spikes
    light = np.full((1, 81), 2.0)
    surface = np.full((1, 81), 0.25)
    light[0, 40] += 30.0
    surface[0, 60] += 0.5
    surface[0, 40] += 0.6
    actual = one.multiply(
        one.encode_light(dense(light)), one.encode_surface(dense(surface))
    )
    assert actual.positions.tolist() == [40, 60]
    assert_allclose(one.xyz(actual), dense(light * surface) @ xyz_weights(), rtol=1e-6)
    assert one.storage(actual).tolist() == [7 + 4]


def test_hero_wavelengths_are_unbiased_and_variance_falls_with_paths(checker):
    power = checker.powers[:1] * checker.surfaces[:1]
    spread = []
    for count in (4, 32):
        hero = hero_wavelengths(count)
        actual = hero.xyz(hero.encode_light(np.tile(power, (4000, 1))))
        spread.append(actual.std(axis=0).max())
        error = actual.mean(axis=0) - power @ xyz_weights()
        assert np.abs(error).max() < 4 * spread[-1] / 4000**0.5
    assert spread[1] < spread[0] / 8**0.5
