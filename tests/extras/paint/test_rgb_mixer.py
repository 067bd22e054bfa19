"""The mixer of RGB: its ends, symmetry and smoothness, and the spectra that it stands
for.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import near_black, raises, with_absent_points
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import ColourError, OptionError
from uplift.extras.colour.srgb import decode
from uplift.extras.paint.bands import MOVES, choose_bands, random_mixtures
from uplift.extras.paint.pigments import dispersive, from_opaque
from uplift.extras.paint.rgb_mixer import SIZE, make_mixer
from uplift.lookup.cube import Cube


@pytest.fixture(scope="module")
def mixer(small_cube):
    return make_mixer(small_cube)


@pytest.fixture
def pairs(rng):
    """Pairs (400, 2, 3), with corners and edges of the cube."""
    colours = decode(rng.random((400, 2, 3)))
    colours[:100] = colours[:100].round()
    colours[100:200, :, 0] = 0
    return colours


@pytest.fixture
def shares(rng):
    return rng.random(400)


def test_mixtures_begin_and_end_at_their_colours(mixer, pairs, shares):
    first, second = pairs[:, 0], pairs[:, 1]
    assert_allclose(mixer.mix(first, second, 0), first, atol=1e-12)
    assert_allclose(mixer.mix(first, second, 1), second, atol=1e-12)
    assert_allclose(mixer.mix(first, first, shares), first, atol=1e-12)


def test_the_order_of_colours_is_free(mixer, pairs, shares):
    mixed = mixer.mix(pairs[:, 0], pairs[:, 1], shares)
    turned = mixer.mix(pairs[:, 1], pairs[:, 0], 1 - shares)
    assert_allclose(mixed, turned, atol=1e-12)
    assert ((mixed >= 0) & (mixed <= 1)).all()


def test_many_colours_mix_as_two_and_latents_add(mixer, pairs):
    mixed = mixer.mix(pairs[:, 0], pairs[:, 1], 0.25)
    assert_allclose(mixer.mix_all(pairs, [21, 7]), mixed, atol=1e-12)
    latents = mixer.latent(pairs)
    assert latents.shape[-1] == SIZE
    added = 0.75 * latents[:, 0] + 0.25 * latents[:, 1]
    assert_allclose(mixer.colour(added), mixed, atol=1e-12)


def of_spectra(cube, pairs, shares):
    """Linear RGB (n, 3) of mixtures by whole spectra, clipped to [0, 1]."""
    sensor = cube.data.sensor
    paints = from_opaque(cube.reflectance(pairs), dispersive(sensor))
    mixed = paints.mix(np.stack([1 - shares, shares], axis=1)).opaque_reflectance()
    return np.clip(sensor.rgb(mixed), 0, 1)


def test_mixtures_are_near_those_of_spectra(small_cube, mixer, rng, shares):
    pairs = decode(rng.random((400, 2, 3)))
    mixed = mixer.mix(pairs[:, 0], pairs[:, 1], shares)
    sensor = small_cube.data.sensor
    exact = of_spectra(small_cube, pairs, shares)
    errors = delta_e_rgb(sensor, exact, mixed)
    means = (1 - shares[:, None]) * pairs[:, 0] + shares[:, None] * pairs[:, 1]
    assert errors.mean() < 0.05 * delta_e_rgb(sensor, exact, means).mean()
    assert np.quantile(errors, 0.95) < 2


def test_chosen_bands_have_smaller_errors_than_even_ones(small_cube, monkeypatch):
    mixtures = random_mixtures(small_cube)
    errors = []
    for moves in (MOVES, ()):
        monkeypatch.setattr("uplift.extras.paint.bands.MOVES", moves)
        bands = choose_bands(small_cube)
        mixed = mixtures.in_bands(bands.means) @ bands.to_rgb.T
        errors.append(np.square((mixed - mixtures.rgb) * mixtures.importance).mean())
    assert errors[0] < 0.8 * errors[1]


def test_wide_gamuts_mix(rng):
    mixer = make_mixer(uplift.load("acescg"), dim=5)
    first, second = rng.random((2, 50, 3))
    assert_allclose(mixer.mix(first, second, 1), second, atol=1e-12)
    assert np.isfinite(mixer.mix(first, second, 0.3)).all()


@pytest.mark.parametrize("colour", [[0.5, 0.5], [0.5, 0.5, 1.1], [np.nan, 0, 0], "red"])
def test_bad_colours(mixer, colour):
    with raises(ColourError):
        mixer.mix_all([colour], [1])


@pytest.mark.parametrize("share", [-0.1, np.nan, [0.5, 2]])
def test_bad_shares(mixer, share):
    with raises(OptionError):
        mixer.mix(np.zeros(3), np.ones(3), share)


@pytest.mark.parametrize("parts", [[0, 0], [1, -1], [np.inf, 1]])
def test_bad_parts(mixer, parts):
    with raises(OptionError):
        mixer.mix_all(np.eye(3)[:2], parts)


@pytest.mark.parametrize("dim", [1, 66])
def test_dims_without_a_mixer(small_cube, dim):
    with raises(OptionError, "option"):
        make_mixer(small_cube, dim)


def test_cubes_without_a_mixer(small_cube):
    data = small_cube.data
    with raises(OptionError, "sparse-cube"):
        make_mixer(Cube(with_absent_points(data, near_black(data))), 9)
