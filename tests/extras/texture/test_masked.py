"""Textures of several cubes: numbers and weights in masks, soft edges, and the errors
of masks that do not fit.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

import uplift
from tests.helpers import raises
from uplift.common.errors import OptionError, TextureError
from uplift.extras import texture

from .conftest import WAVELENGTHS, planes, read_channels, spectra_by, write_exr

SHAPE = (20, 30)
SPECTRUM = texture.Spectrum(WAVELENGTHS)


@pytest.fixture(scope="module")
def cubes(small_cube, plain_cube, repository):
    """Three cubes of one space; the first two have one model."""
    third = uplift.load(repository / "cubes" / "moments-16.uplift")
    return small_cube, plain_cube, third


@pytest.fixture(scope="module")
def image(tmp_path_factory, colours):
    path = tmp_path_factory.mktemp("image") / "image.exr"
    return write_exr(path, planes(colours))


def prepared(cubes, mask, encoding=SPECTRUM):
    uplifters = [
        texture.prepare(cube, encoding, depth="float", threads=1) for cube in cubes
    ]
    return texture.prepare_masked(uplifters, mask)


@pytest.fixture
def save(tmp_path):
    """Function that writes a mask of integers or floats."""

    def save(values):
        if values.dtype == np.float32:
            return write_exr(tmp_path / "mask.exr", {"Y": values})
        Image.fromarray(values).save(tmp_path / "mask.png")
        return tmp_path / "mask.png"

    return save


@pytest.fixture
def converted(tmp_path, image, save):
    """From cubes, a mask and an encoding to the channels (h, w, N) of the texture."""

    def converted(cubes, mask, encoding=SPECTRUM):
        converter = prepared(cubes, save(mask), encoding)
        texture.convert(converter, image, tmp_path / "out.exr", force=True)
        return read_channels(tmp_path / "out.exr", converter.channels)

    return converted


NUMBERS = np.random.default_rng(1).integers(0, 3, SHAPE, dtype=np.uint8)
RAMP = np.tile(np.linspace(0, 1, SHAPE[1], dtype=np.float32), (SHAPE[0], 1))
CODES = np.random.default_rng(3).integers(1, 256, (*SHAPE, 3), dtype=np.uint8)


def grey(codes):
    """A mask of integers, and the weights of two cubes."""
    share = codes / np.iinfo(codes.dtype).max
    return codes, np.stack([1 - share, share], axis=-1)


@pytest.mark.parametrize(
    ("mask", "weights"),
    [
        (NUMBERS, np.eye(3)[NUMBERS]),
        grey((RAMP * 255).astype(np.uint8)),
        grey((RAMP * 65535).astype(np.uint16)),
        (RAMP, np.stack([1 - RAMP, RAMP], axis=-1)),
        (CODES, CODES / CODES.sum(axis=-1, keepdims=True)),
    ],
    ids=["numbers", "8 bits", "16 bits", "floats", "colours"],
)
@pytest.mark.parametrize("band", [1 << 25, 1])
def test_masks_choose_or_mix_cubes(
    mask, weights, band, converted, cubes, colours, monkeypatch
):
    monkeypatch.setattr("uplift.extras.images.writer.MAX_BAND_BYTES", band)
    monkeypatch.setattr("uplift.extras.images.image.MAX_BAND_BYTES", band)
    chosen = cubes[: weights.shape[-1]]
    found = converted(chosen, mask)
    spectra = np.stack([cube.reflectance(colours, WAVELENGTHS) for cube in chosen])
    assert np.abs(spectra[0] - spectra[1]).max() > 0.05
    expected = np.einsum("hwk,khwn->hwn", weights, spectra)
    assert_allclose(found, expected, atol=3e-6)


def test_moments_and_multipliers_mix_as_reflectances_do(
    converted, cubes, colours, sensor
):
    """Multipliers are exact in colour, and of one cube where the mask is black."""
    mask = np.tile(np.uint8([0, 128, 255]), (SHAPE[0], 10))
    found = converted(cubes[:2], mask, texture.Moments())[:, 1::3]
    one, two = (cube.coefficients(colours[:, 1::3]) for cube in cubes[:2])
    assert_allclose(found, one + 128 / 255 * (two - one), atol=1e-5)
    encoding = texture.Multipliers()
    found = converted(cubes[:2], mask, encoding).astype(float)
    spectra = spectra_by(found, encoding, cubes[0])
    assert_allclose(sensor.rgb(spectra), colours, atol=2e-4)
    alone = texture.prepare(cubes[0], encoding, threads=1).pixels.sample
    assert_array_equal(found[:, ::3], alone(colours[:, ::3]))


NEARLY_BLACK = np.zeros((*SHAPE, 3), np.uint8) + np.uint8([1, 0, 0])
PARTLY_BLACK = np.eye(*SHAPE, dtype=np.uint8)[..., None] * np.uint8([9, 0, 0])


@pytest.mark.parametrize(
    ("values", "count"),
    [
        (np.zeros((20, 29), np.uint8), 2),
        (np.full(SHAPE, 2, np.uint8), 2),  # a number, or a weight that is nearly black
        (np.full(SHAPE, 255, np.uint8), 3),
        (NEARLY_BLACK, 2),
        (PARTLY_BLACK, 3),
        *((np.full(SHAPE, value, np.float32), 2) for value in (np.nan, -0.1, 1.1)),
    ],
)
def test_masks_that_do_not_fit_are_refused(image, cubes, tmp_path, save, values, count):
    mask = save(values)
    with raises(TextureError) as caught:
        texture.convert(prepared(cubes[:count], mask), image, tmp_path / "out.exr")
    assert caught.value.path == mask
    assert not (tmp_path / "out.exr").exists()


def test_cubes_that_do_not_fit_are_refused(cubes, small_sigmoid_cube, save, tmp_path):
    mask = save(NUMBERS)
    for others, encoding, code in (
        ((), SPECTRUM, "option"),
        ((small_sigmoid_cube,), texture.Multipliers(), "option"),
        ((uplift.load("ACEScg"),), SPECTRUM, "cubes-of-different-spaces"),
    ):
        with raises(OptionError, code):
            prepared((cubes[0], *others), mask, encoding)
    with raises(TextureError, "file-not-found"):
        prepared(cubes[:2], tmp_path / "none.png")


def test_an_entry_outside_the_space_answers_where_its_cube_is_chosen(
    cyan_cube, plain_cube, tmp_path, save
):
    """Three pixels of its colour: of its cube, of one without it, and half of each."""
    outside = cyan_cube.data.atlas.outside
    rgb = outside.rgb[0]
    image = write_exr(tmp_path / "cyan.exr", planes(np.float32([[rgb] * 3])))
    mask = save(np.float32([[0, 1, 0.5]]))
    converter = prepared((cyan_cube, plain_cube), mask)
    result = texture.convert(converter, image, tmp_path / "out.exr")
    clipped = rgb.clip(0, 1)
    entry = outside.spectra.reflectance(np.array([0]), np.array(WAVELENGTHS))[0]
    plain = plain_cube.reflectance(clipped, WAVELENGTHS)
    for names, one, two in (
        ("RGB", rgb, clipped),
        (converter.channels, entry, plain),
    ):
        found = read_channels(result.target, names)[0]
        assert_allclose(found, [one, two, (one + two) / 2], atol=1e-5)
