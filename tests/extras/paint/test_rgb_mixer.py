"""The mixer of RGB: its ends, symmetry and smoothness, and the spectra that it stands
for.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import RegularGridInterpolator

import uplift
from tests.helpers import near_black, raises, with_absent_points
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import ColourError, OptionError
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.paint.bands import (
    BANDS,
    _even_edges,
    _fit,
    choose_bands,
    random_mixtures,
)
from uplift.extras.paint.pigments import dispersive, from_opaque
from uplift.extras.paint.rgb_mixer import SIZE, interpolate, make_mixer
from uplift.lookup.cube import Cube

BLUE, YELLOW = decode(np.array([[0, 33, 133], [252, 210, 0]]) / 255)


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
    first, second = pairs[:, 0], pairs[:, 1]
    mixed = mixer.mix(first, second, shares)
    assert_allclose(mixed, mixer.mix(second, first, 1 - shares), atol=1e-12)
    assert mixed.min() >= 0
    assert mixed.max() <= 1


def test_many_colours_mix_as_two(mixer, pairs, shares):
    parts = 7 * np.stack([1 - shares, shares], axis=1)
    mixed = mixer.mix(pairs[:, 0], pairs[:, 1], shares)
    assert_allclose(mixer.mix_all(pairs, parts), mixed, atol=1e-12)
    twice = pairs[:, [0, 1, 0]]
    halves = parts[:, [0, 1, 0]] * [0.5, 1, 0.5]
    assert_allclose(mixer.mix_all(twice, halves), mixed, atol=1e-12)


def test_latents_add(mixer, pairs):
    latents = mixer.latent(pairs)
    assert latents.shape == (400, 2, SIZE)
    assert_allclose(
        mixer.colour(latents.mean(axis=1)),
        mixer.mix(pairs[:, 0], pairs[:, 1], 0.5),
        atol=1e-12,
    )


def test_blue_and_yellow_are_green(mixer):
    red, green, blue = mixer.mix(BLUE, YELLOW, 0.5)
    assert green > 2 * max(red, blue)


def test_greys_stay_near_neutral(mixer):
    greys = np.linspace(0, 1, 12)[:, None].repeat(3, axis=1)
    mixed = mixer.mix(greys[:, None], greys, 0.5)
    assert np.ptp(encode(mixed), axis=-1).max() < 0.02


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
    errors = delta_e_rgb(sensor, of_spectra(small_cube, pairs, shares), mixed)
    means = delta_e_rgb(
        sensor,
        of_spectra(small_cube, pairs, shares),
        (1 - shares[:, None]) * pairs[:, 0] + shares[:, None] * pairs[:, 1],
    )
    assert errors.mean() < 0.05 * means.mean()
    assert np.quantile(errors, 0.95) < 2


def test_mixtures_have_no_kink_along_the_share(mixer, rng):
    """Halving the step quarters the second differences; of a kink it halves them."""
    first, second = 0.1 + 0.8 * rng.random((2, 100, 1, 3))
    coarse, fine = (
        mixer.mix(first, second, np.linspace(0, 1, count)) for count in (801, 1601)
    )
    inside = ((fine > 0) & (fine < 1)).all(axis=(1, 2))
    assert inside.mean() > 0.5
    bends = [
        np.abs(np.diff(steps[inside], 2, axis=1)).max(axis=(1, 2))
        for steps in (coarse, fine)
    ]
    assert (bends[1] < 0.4 * bends[0] + 1e-9).all()


def test_mixtures_follow_their_colours(mixer, rng):
    """A small change of a colour changes the mixture a little."""
    first, second = decode(rng.random((2, 300, 3)))
    change = np.where(second < 0.5, 1e-4, -1e-4)
    moves = mixer.mix(first, second + change, 0.5) - mixer.mix(first, second, 0.5)
    assert np.abs(moves).max() < 0.01


def test_interpolation_is_linear_along_each_axis(rng):
    table = rng.integers(0, 65536, (4, 4, 4, 5)).astype(np.uint16)
    places = rng.random((50, 3))
    places[:2] = [[0], [1]]
    oracle = RegularGridInterpolator([np.linspace(0, 1, 4)] * 3, table.astype(float))
    assert_allclose(interpolate(table, places), oracle(places))


def test_bands_divide_the_wavelengths(small_cube):
    bands = choose_bands(small_cube)
    assert ((bands.means > 0).sum(axis=0) == 1).all()
    assert_allclose(bands.means.sum(axis=1), 1)
    assert_allclose(bands.to_rgb.sum(axis=1), 1)


def test_chosen_bands_have_smaller_errors_than_even_ones(small_cube):
    sensor = small_cube.data.sensor
    mixtures = random_mixtures(small_cube)

    def error(bands):
        mixed = mixtures.in_bands(bands.means) @ bands.to_rgb.T
        return np.square((mixed - mixtures.rgb) * mixtures.importance).mean()

    even, even_error = _fit(sensor, _even_edges(sensor), mixtures)
    assert error(even) == pytest.approx(even_error)
    assert error(choose_bands(small_cube)) < 0.8 * even_error
    assert len(even.means) == BANDS


def test_wide_gamuts_mix(rng):
    cube = uplift.load("acescg")
    mixer = make_mixer(cube, dim=5)
    colours = rng.random((50, 2, 3))
    first, second = colours[:, 0], colours[:, 1]
    assert_allclose(mixer.mix(first, second, 1), second, atol=1e-12)
    assert np.isfinite(mixer.mix(first, second, 0.3)).all()


@pytest.mark.parametrize(
    "colour", [[0.5, 0.5], [0.5, 0.5, 1.1], [-0.1, 0, 0], [np.nan, 0, 0], "red"]
)
def test_bad_colours(mixer, colour):
    with raises(ColourError):
        mixer.mix(colour, [0.5, 0.5, 0.5], 0.5)
    with raises(ColourError):
        mixer.mix_all([colour], [1])


BAD = [
    *(("mix", (BLUE, YELLOW, share)) for share in (-0.1, 1.1, np.nan, [0.5, 2])),
    *(("mix_all", ([BLUE, YELLOW], parts)) for parts in ([0, 0], [1, -1], [np.inf, 1])),
]


@pytest.mark.parametrize(("method", "values"), BAD)
def test_bad_shares_and_parts(mixer, method, values):
    with raises(OptionError):
        getattr(mixer, method)(*values)


@pytest.mark.parametrize(("dim", "code"), [(1, "option"), (66, "option"), (9, None)])
def test_cubes_and_dims_without_a_mixer(small_cube, dim, code):
    data = small_cube.data
    cube = small_cube
    if code is None:
        code = "sparse-cube"
        cube = Cube(with_absent_points(data, near_black(data)))
    with raises(OptionError, code):
        make_mixer(cube, dim)
