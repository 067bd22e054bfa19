"""Spectra of colours that are known under several lights."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import ATLASES
from tests.helpers import quiet_build, raises, without_evidence
from uplift.atlas.resampling import resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import ColourError, OptionError, UnknownNameError
from uplift.extras.photographs.answers import LEAST_NOISE, prepare
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.metamers import RANK, learn_metamers
from uplift.extras.photographs.photograph import photograph
from uplift.models.brightness import brightness

RGB = np.random.default_rng(5).random((200, 3)) ** 2


@pytest.fixture(scope="module")
def tungsten(macbeth_cube_16):
    sensor = macbeth_cube_16.data.sensor
    return prepare(macbeth_cube_16, [photograph(sensor, "A")])


@pytest.fixture(scope="module")
def macbeth_cube_16():
    return uplift.load(ATLASES.parent / "cubes" / "moments-16-macbeth.uplift")


def materials(sensor, name):
    """Linear RGB and reflectances of a shipped set, inside the space."""
    atlas = uplift.read_atlas(ATLASES / f"{name}.txt")
    measured = resample(atlas, sensor.wavelengths).values
    rgb = sensor.rgb(measured)
    inside = in_unit_cube(rgb)
    return np.clip(rgb[inside], 0, 1), measured[inside]


def test_what_the_cube_answers_is_answered_again(tungsten):
    spectra = tungsten.cube.reflectance(RGB)
    others = spectra @ tungsten.matrix.T
    assert_allclose(tungsten.reflectance(RGB, others), spectra, atol=1e-9)
    at = [400.0, 502.5, 700.0]
    few = tungsten.cube.reflectance(RGB, at)
    assert_allclose(tungsten.reflectance(RGB, others, at), few, atol=1e-9)


def test_spectra_have_both_colours_where_materials_can_have_them(tungsten):
    sensor = tungsten.cube.data.sensor
    rgb, measured = materials(sensor, "pmc")
    others = measured @ tungsten.matrix.T
    spectra = tungsten.reflectance(rgb, others)
    assert_allclose(sensor.rgb(spectra), rgb, atol=1e-6)
    off = np.abs(spectra @ tungsten.matrix.T - others).max(axis=1)
    assert np.median(off) < 1e-3


def test_the_posterior_is_that_of_gaussian_residuals(tungsten):
    """The plain formula with covariances of all wavelengths, colour by colour."""
    rgb = RGB[:20] * 0.3 + 0.2
    noise = tungsten.noise._replace(share=0.01, floor=0.002)
    photographs = replace(tungsten, noise=noise)
    expected = tungsten.cube.reflectance(rgb)
    matrix = tungsten.matrix
    others = expected @ matrix.T * [1.01, 1.0, 0.99]
    scores = tungsten.metamers.covariance(rgb)
    directions = photographs.directions(scores)
    found = photographs.answer(rgb, others, directions=directions).spectra
    components = tungsten.metamers.components
    levels = brightness(rgb) ** 2
    for row, spectrum in enumerate(found):
        covariance = levels[row] * components.T @ scores[row] @ components
        variance = noise.variance(others[row]) + noise.variance(rgb[row])
        inner = matrix @ covariance @ matrix.T + np.diag(variance + LEAST_NOISE**2)
        residual = others[row] - matrix @ expected[row]
        gain = covariance @ matrix.T @ np.linalg.inv(inner)
        assert_allclose(spectrum, expected[row] + gain @ residual, atol=1e-9)


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_answers_are_reflectances_for_any_photograph(tungsten, seed):
    random = np.random.default_rng(seed)
    rgb = random.random((20, 3))
    others = random.normal(0.5, 1, (20, 3))
    others[random.random((20, 3)) < 0.1] = np.nan
    spectra = tungsten.reflectance(rgb, others)
    assert spectra.min() >= 0
    assert spectra.max() <= 1
    assert_allclose(tungsten.cube.data.sensor.rgb(spectra), rgb, atol=1e-4)


def test_photographs_that_contradict_each_other_are_not_used(tungsten):
    rgb = np.full((2, 3), 0.2)
    answers = tungsten.answer(rgb, np.array([[0.2, 0.2, 0.2], [0.9, 0.05, 0.05]]))
    assert answers.contradicts.tolist() == [False, True]
    assert_array_equal(answers.spectra[1], tungsten.cube.reflectance(rgb)[1])


def test_unknown_components_do_not_count(tungsten):
    rgb, measured = materials(tungsten.cube.data.sensor, "rawtoaces")
    others = measured @ tungsten.matrix.T
    errors = []
    for known in (3, 2, 0):
        others[:, known:] = np.nan
        found = tungsten.reflectance(rgb, others)
        error = delta_e_spectra(observer.light("HP1"), found, measured)
        errors.append(error.mean())
    assert errors[0] < errors[1] < errors[2]
    assert_allclose(found, tungsten.cube.reflectance(rgb), atol=1e-9)


def test_metamers_are_black_and_few(plain_cube):
    metamers = learn_metamers(plain_cube)
    assert len(metamers.components) == RANK
    colours = metamers.components @ plain_cube.data.sensor.matrix.T
    assert_allclose(colours, 0, atol=1e-6)
    assert (np.linalg.eigvalsh(metamers.covariance(RGB)) > -1e-12).all()


@pytest.fixture(scope="module")
def halves():
    """A cube of one half of a set; linear RGB and reflectances of the other half."""
    atlas = uplift.read_atlas(ATLASES / "rawtoaces.txt")
    cube = quiet_build(atlas[::2], dim=8, leave_out=["rawtoaces"])
    measured = resample(atlas[1::2], cube.wavelengths).values
    rgb = cube.data.sensor.rgb(measured)
    inside = in_unit_cube(rgb)
    return cube, rgb[inside], measured[inside]


@pytest.mark.parametrize("noise", [(0.0, 0.0), (0.01, 0.001)])
def test_standard_errors_hold_for_materials_like_the_left_out(halves, noise):
    """68 % and 95 % of the other half."""
    cube, rgb, measured = halves
    photographs = prepare(cube, [photograph(cube.data.sensor, "A")], noise)
    random = np.random.default_rng(2)

    def noisy(values):
        scale = np.sqrt(photographs.noise.variance(values))
        return values + scale * random.standard_normal(values.shape)

    rgb = np.clip(noisy(rgb), 0, 1)
    spectra = photographs.reflectance(rgb, noisy(measured @ photographs.matrix.T))
    within = []
    for name in ("FL2", "FL11", "LED-B3", "HP1"):
        light = observer.light(name)
        radii = light_errors(photographs, light)(rgb)
        error = delta_e_spectra(light, spectra, measured)
        within.append((error[:, None] <= radii).mean(axis=0))
    assert np.mean(within, axis=0) == pytest.approx([0.68, 0.95], abs=0.08)


def test_cameras_and_balances(macbeth_cube_16):
    sensor = macbeth_cube_16.data.sensor
    white = np.ones(81)
    warm = photograph(sensor, "A", balance="none").matrix
    assert_allclose(photograph(sensor, "A").matrix @ white, 1)
    assert (warm @ white)[0] > 1 > (warm @ white)[2]
    assert_allclose(warm, sensor.xyz_to_rgb @ observer.light("A").xyz)
    card = photograph(sensor, "A", balance="camera").matrix
    assert_allclose(card * (warm @ white)[:, None], warm)
    camera = "Nikon 5100 (NPL)"
    raw = photograph(observer.sensor("camera", "D65", camera), "A", balance="none")
    assert_allclose(photograph(sensor, "A", camera).matrix @ white, 1)
    of_other = photograph(sensor, "A", camera, "none").matrix
    assert_allclose(raw.matrix, of_other, rtol=1e-6)
    red, green, blue = of_other @ white
    assert red > green > blue


@pytest.mark.parametrize(
    ("light", "balance"), [("D65", "light"), ("none", "light"), ("A", "auto")]
)
def test_bad_photographs(sensor, light, balance):
    with raises((OptionError, UnknownNameError)):
        photograph(sensor, light, balance=balance)


@pytest.mark.parametrize(
    ("count", "noise"), [(0, (0, 0)), (2, (0, 0)), (1, (-0.1, 0)), (1, (0, np.nan))]
)
def test_bad_sets_of_photographs(tungsten, count, noise):
    with raises(OptionError, "option"):
        prepare(tungsten.cube, tungsten.further * count, noise)


@pytest.mark.parametrize(
    ("rgb", "others"), [([1.1, 0.2, 0.3], [0.1, 0.2, 0.3]), ([0.1, 0.2, 0.3], [0.1])]
)
def test_bad_colours(tungsten, rgb, others):
    with raises((ColourError, OptionError)):
        tungsten.reflectance(rgb, others)


def test_cubes_without_materials_are_refused(tungsten):
    with raises(OptionError, "too-few-entries"):
        prepare(without_evidence(tungsten.cube), tungsten.further)
