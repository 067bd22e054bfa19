"""Spectra of one colour: they have it, and spread as materials do."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.helpers import raises
from uplift.common.errors import ColourError, OptionError
from uplift.extras.photographs.samples import TAIL, prepare_samples
from uplift.lookup.errors_under_lights import evidence
from uplift.models.brightness import brightness


@pytest.fixture(scope="module")
def sampler():
    return prepare_samples(uplift.load())


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_samples_are_reflectances_of_the_colour(sampler, seed):
    rgb = np.random.default_rng(seed).random((2, 5, 3)) ** 2
    spectra = sampler(rgb, 4, seed)
    assert spectra.shape == (2, 5, 4, 81)
    assert spectra.min() >= 0
    assert spectra.max() <= 1
    expected = np.broadcast_to(rgb[..., None, :], (2, 5, 4, 3))
    assert_allclose(sampler.cube.data.sensor.rgb(spectra), expected, atol=2e-6)


def test_samples_of_a_wide_gamut_have_the_colour_or_the_nearest_realisable_one():
    cube = uplift.load("acescg")
    sensor = cube.data.sensor
    rgb = np.random.default_rng(2).random((60, 3))
    (colours,) = sensor.rgb(prepare_samples(cube)(rgb, 1, 1)).swapaxes(0, 1)
    assert_allclose(colours, sensor.rgb(cube.reflectance(rgb)), atol=1e-4)


def test_one_seed_gives_the_same_samples_and_a_generator_goes_on(sampler, monkeypatch):
    rgb = np.random.default_rng(1).random((4, 3))
    first = sampler(rgb, 3, 7)
    random = np.random.default_rng(7)
    assert_array_equal(sampler(rgb, 3, random), first)
    assert np.abs(sampler(rgb, 3, random) - first).max() > 0.01
    few = sampler(rgb, 3, 7, [400.0, 502.5, 700.0])
    assert_allclose(few[..., [0, 2]], first[..., [4, 64]], atol=2e-3)
    monkeypatch.setattr("uplift.extras.photographs.samples.BLOCK_SPECTRA", 2)
    assert_allclose(sampler(rgb, 3, 7), first, atol=1e-9)


def test_the_spread_is_that_of_the_covariance(sampler):
    """Of a colour far from 0 and 1, whose samples are hardly moved."""
    rgb = np.array([[0.35, 0.35, 0.35]])
    spectra = sampler(rgb[0], 20_000, 3)
    components = sampler.metamers.components
    level = brightness(rgb)[0] ** 2
    inner = sampler.metamers.covariance(rgb)[0] * TAIL / (TAIL - 2)
    expected = np.sqrt(level * np.diag(components.T @ inner @ components))
    visible = slice(8, 65)
    assert_allclose(spectra.std(axis=0)[visible], expected[visible], rtol=0.1)
    mean = sampler.cube.reflectance(rgb[0])
    assert_allclose(spectra.mean(axis=0)[visible], mean[visible], atol=0.01)


def test_left_out_covariances_do_not_know_their_family(sampler):
    metamers = sampler.metamers
    family = evidence(sampler.cube.data).family
    rows = family == family[0]
    expected = metamers.left_out_covariance(family)[rows]
    others = replace(metamers, scores=metamers.scores * ~rows[:, None])
    assert_allclose(others.left_out_covariance(family)[rows], expected)


@pytest.mark.parametrize(
    ("rgb", "count", "seed"),
    [
        ([1.1, 0.2, 0.3], 1, 0),
        ([0.1, 0.2, 0.3], 0, 0),
        ([0.1, 0.2, 0.3], True, 0),
        ([0.1, 0.2, 0.3], 1, -1),
        ([0.1, 0.2, 0.3], 1, None),
    ],
)
def test_bad_input(sampler, rgb, count, seed):
    with raises((ColourError, OptionError)):
        sampler(rgb, count, seed)
