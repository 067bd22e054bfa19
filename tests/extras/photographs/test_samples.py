"""Spectra of one colour: they have it, and spread as materials do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import ATLASES
from tests.helpers import quiet_build, raises, without_evidence
from uplift.atlas.resampling import resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import ColourError, OptionError
from uplift.extras.photographs.samples import TAIL, prepare_samples
from uplift.lookup.errors_under_lights import evidence
from uplift.models.brightness import brightness

LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
COUNT = 100


@pytest.fixture(scope="module")
def sampler():
    return prepare_samples(uplift.load())


@given(st.integers(0, 2**32 - 1))
def test_samples_are_reflectances_of_the_colour(sampler, seed):
    rgb = np.random.default_rng(seed).random((10, 3)) ** 2
    spectra = sampler(rgb, 5, seed)
    assert spectra.shape == (10, 5, 81)
    assert spectra.min() >= 0
    assert spectra.max() <= 1
    colours = sampler.cube.data.sensor.rgb(spectra)
    assert_allclose(colours, np.broadcast_to(rgb[:, None], colours.shape), atol=2e-6)


def test_samples_of_a_wide_gamut_have_the_colour_or_the_nearest_realisable_one():
    cube = uplift.load("acescg")
    rgb = np.random.default_rng(2).random((60, 3))
    colours = cube.data.sensor.rgb(prepare_samples(cube)(rgb, 4, 1))
    nearest = cube.data.sensor.rgb(cube.reflectance(rgb))
    assert_allclose(
        colours, np.broadcast_to(nearest[:, None], colours.shape), atol=1e-4
    )


def test_one_seed_gives_the_same_samples_and_a_generator_goes_on(sampler, monkeypatch):
    rgb = np.random.default_rng(1).random((4, 3))
    first = sampler(rgb, 3, 7)
    assert_array_equal(sampler(rgb, 3, 7), first)
    random = np.random.default_rng(7)
    assert_array_equal(sampler(rgb, 3, random), first)
    assert np.abs(sampler(rgb, 3, random) - first).max() > 0.01
    monkeypatch.setattr("uplift.extras.photographs.samples.BLOCK_SPECTRA", 2)
    assert_allclose(sampler(rgb, 3, 7), first, atol=1e-9)


def test_shapes_and_wavelengths(sampler):
    rgb = np.full((2, 3, 3), 0.4)
    spectra = sampler(rgb, 5, 1)
    assert spectra.shape == (2, 3, 5, 81)
    at = [400.0, 502.5, 700.0]
    coarse = sampler(rgb, 5, 1, at)
    assert coarse.shape == (2, 3, 5, 3)
    assert_allclose(coarse[..., [0, 2]], spectra[..., [4, 64]], atol=2e-3)
    assert sampler([0.1, 0.2, 0.3], 1, 0).shape == (1, 81)
    assert sampler(np.zeros((0, 3)), 2, 0).shape == (0, 2, 81)


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


def shares_within(around, samples, measured):
    """Shares of materials (M, N) whose colours are as near to means (M, N) as 68 % and
    95 % of samples (M, n, N), over lights.
    """
    within = []
    means = np.repeat(around, samples.shape[1], axis=0)
    for name in LIGHTS:
        light = observer.light(name)
        spread = delta_e_spectra(light, samples.reshape(means.shape), means)
        spread = spread.reshape(samples.shape[:2])
        radii = np.quantile(spread, (0.68, 0.95), axis=1).T
        error = delta_e_spectra(light, around, measured)
        within.append(error[:, None] <= radii)
    return np.concatenate(within).mean(axis=0)


def test_samples_spread_as_families_that_were_left_out(sampler):
    known = evidence(sampler.cube.data)
    rows = slice(None, None, 3)
    measured = np.asarray(known.measured, dtype=float)[rows]
    rgb = np.clip(sampler.cube.data.sensor.rgb(measured), 0, 1)
    around = np.clip(known.left_out[rows], 0, 1).astype(float)
    covariance = sampler.metamers.left_out_covariance(known.family)[rows]
    random = np.random.default_rng(4)
    at = sampler.cube.wavelengths
    samples = sampler.draw(around, rgb, covariance, COUNT, random, at)
    shares = shares_within(around, samples, measured)
    assert shares == pytest.approx([0.68, 0.95], abs=0.06)


def test_samples_spread_as_the_other_half_of_an_atlas():
    atlas = uplift.read_atlas(ATLASES / "rawtoaces.txt")
    cube = quiet_build(atlas[::2], dim=8, leave_out=["rawtoaces"])
    sensor = cube.data.sensor
    measured = resample(atlas[1::2], sensor.wavelengths).values
    rgb = sensor.rgb(measured)
    inside = in_unit_cube(rgb)
    rgb = np.clip(rgb[inside], 0, 1)
    samples = prepare_samples(cube)(rgb, COUNT, 5)
    shares = shares_within(cube.reflectance(rgb), samples, measured[inside])
    assert shares == pytest.approx([0.68, 0.95], abs=0.08)


def test_bad_input(sampler):
    with raises(ColourError):
        sampler([1.1, 0.2, 0.3], 1, 0)
    with raises(ColourError):
        sampler([0.1, np.nan, 0.3], 1, 0)
    for count in (0, -1, 1.5, True, "3", None):
        with raises(OptionError):
            sampler([0.1, 0.2, 0.3], count, 0)
    for seed in (-1, 1.5, True, "a", None):
        with raises(OptionError):
            sampler([0.1, 0.2, 0.3], 1, seed)
    with raises(OptionError):
        sampler([0.1, 0.2, 0.3], 1, 0, [-400])
    with raises(OptionError, "too-few-entries"):
        prepare_samples(without_evidence(sampler.cube))
