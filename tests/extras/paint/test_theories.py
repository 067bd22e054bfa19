"""Models by name: criteria of Fishkin 1983, 10.4, heuristics, and mixtures of measured
paints.
"""

import colorsys

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from benchmarks.mixtures import acrylics, published
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.extras.paint.theories import (
    hsl_to_rgb,
    mix_phosphors,
    mix_ryb,
    mixers,
    phosphor_curves,
    rgb_to_hsl,
)

OBEYED = {
    "Kubelka–Munk": "same darker lighter green",
    "Kubelka–Munk, in oil (index 1.5)": "same darker lighter",
    "Kubelka–Munk, S = √R": "same darker lighter green",
    "Kubelka–Munk, S = 1": "same darker lighter",
    "Amy's approximation": "darker green",
    "Duntley, in directed light": "same darker lighter green",
    "dyes on white": "same darker lighter green",
    "filters": "darker green",
    "average of RGB": "same darker lighter",
    "product of RGB": "darker",
    "RYB-HSL": "same darker lighter green",
    "phosphor curves": "darker green",
}
"""Criteria of painters that each model obeys with some margin: a colour mixed with
itself is the same, with black darker, with white lighter; blue and yellow are green.
"""
RATIOS = np.array([(1.5, 0.5), (1, 1), (0.5, 1.5)])


@pytest.fixture(scope="module")
def models():
    return mixers(uplift.load())


@pytest.fixture
def colours(rng):
    return rng.random((8, 3))


@pytest.fixture(scope="module")
def small_models(small_cube):
    return mixers(small_cube)


@pytest.fixture(scope="module")
def patches(small_cube):
    """Linear RGB (n, 3) of the ColorChecker's coloured patches."""
    rgb = small_cube.data.atlas.rgb
    return rgb[np.ptp(rgb, axis=1) > 0.1 * rgb.max(axis=1)]


@pytest.mark.parametrize("name", OBEYED)
def test_models_obey_the_expected_criteria(small_models, sensor, patches, name):
    """Fishkin 1983, 10.4."""
    mix = small_models[name]
    light = sensor.xyz(patches)[:, None, 1]

    def mixed(other):
        pairs = np.stack(np.broadcast_arrays(patches, other), axis=1)
        return np.array([mix(pair, RATIOS) for pair in pairs])

    red, green, blue = mix(np.array([[0, 0, 1.0], [1, 1, 0]]), RATIOS).T
    obeyed = {
        "same": delta_e_rgb(sensor, patches[:, None], mixed(patches)).max() < 0.1,
        "darker": (sensor.xyz(mixed(0))[..., 1] <= light).all(),
        "lighter": (sensor.xyz(mixed(1))[..., 1] >= light).all(),
        "green": (green - np.maximum(red, blue)).max() > 0.01,
    }
    assert all(obeyed[criterion] for criterion in OBEYED[name].split())


@pytest.mark.parametrize(
    ("name", "largest"), [("Kubelka–Munk", 8.0), ("Kubelka–Munk, S = √R", 11.0)]
)
def test_mixtures_of_measured_paints_from_their_rgb(models, sensor, name, largest):
    """Mean ΔE00 over 513 mixtures of acrylics; docs/mixing.md has the table."""
    assert largest - 1 < acrylics().errors(models[name], sensor).mean() < largest


def test_mixbox_s_published_mixtures_are_nearer_than_before(models, sensor):
    """The first one is of cobalt blue and Hansa yellow."""
    examples = published("mixbox")
    now = examples.errors(models["Kubelka–Munk"], sensor)
    before = examples.errors(models["Kubelka–Munk, S = √R"], sensor)
    assert now[0] < 8 < 30 < before[0]
    assert now.mean() < before.mean()


@pytest.mark.parametrize("other", [0, 1])
def test_ryb_shades_keep_their_chromaticity_and_tints_their_hue(colours, other):
    pairs = np.stack([colours, np.full_like(colours, other)], axis=1)
    assert_allclose(mix_ryb(pairs, [1, 3]), (colours + 3 * other) / 4, atol=1e-12)


@pytest.mark.parametrize(
    "pair", [([0, 0, 1], [1, 0.5, 0]), ([1, 1, 0], [1, 0, 1])], ids=["blue", "yellow"]
)
def test_the_thesis_s_complements(pair):
    """Blue and orange, yellow and purple are opposite."""
    assert_allclose(mix_ryb([pair], [1, 1]), 0.5, atol=1e-12)


def test_phosphor_curves_give_their_colours_and_do_not_amplify_light(colours):
    curves, _ = phosphor_curves()
    assert curves.sum(axis=0).max() == pytest.approx(1)
    assert_allclose(mix_phosphors(colours[:, None], np.ones((8, 1))), colours)
    twice = mix_phosphors(colours[:, None], np.full((8, 1), 2.0))
    assert (twice.sum(axis=1) < colours.sum(axis=1)).all()
    # Impurity of real filters in Fishkin 1983: white on white is darker than white.
    assert (mix_phosphors(np.ones((2, 3)), np.ones(2)) < 0.6).all()


def test_hsl_agrees_with_the_standard_library_and_round_trips(rng):
    rgb = np.concatenate([rng.random((500, 3)), rng.integers(0, 3, (500, 3)) / 2])
    found = rgb_to_hsl(rgb)
    assert_allclose(hsl_to_rgb(found), rgb, atol=1e-12)
    hls = np.array([colorsys.rgb_to_hls(*colour) for colour in rgb])
    assert_allclose(found, hls[:, [0, 2, 1]], atol=1e-12)
    assert_allclose(hsl_to_rgb([-1e-18, 1, 0.5]), [1, 0, 0], atol=1e-12)
