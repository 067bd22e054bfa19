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
from uplift.models.model import evaluate

from .conftest import WAVELENGTHS, planes, read_channels, write_exr

SHAPE = (20, 30)
SPECTRUM = texture.Spectrum(WAVELENGTHS)


@pytest.fixture(scope="module")
def cubes(small_cube, plain_cube, macbeth_cube):
    """Three cubes of one space; the first two have one model."""
    return small_cube, plain_cube, macbeth_cube


@pytest.fixture(scope="module")
def image(tmp_path_factory, colours):
    path = tmp_path_factory.mktemp("image") / "image.exr"
    return write_exr(path, planes(colours))


def prepared(cubes, mask, encoding=SPECTRUM):
    uplifters = [
        texture.prepare(cube, encoding, depth="float", threads=1) for cube in cubes
    ]
    return texture.prepare_masked(uplifters, mask)


def png(path, values):
    Image.fromarray(values).save(path)
    return path


@pytest.fixture
def converted(tmp_path, image):
    """From cubes, a mask and an encoding to the channels (h, w, N) of the texture."""

    def converted(cubes, mask, encoding=SPECTRUM):
        converter = prepared(cubes, mask, encoding)
        texture.convert(converter, image, tmp_path / "out.exr", force=True)
        return read_channels(tmp_path / "out.exr", converter.channels)

    return converted


def spectra(cube, colours):
    return cube.reflectance(colours.reshape(-1, 3), WAVELENGTHS).reshape(*SHAPE, -1)


@pytest.mark.parametrize("band", [1 << 25, 1])
def test_numbers_choose_the_cube(
    converted, cubes, colours, tmp_path, monkeypatch, band
):
    monkeypatch.setattr("uplift.extras.images.writer.MAX_BAND_BYTES", band)
    monkeypatch.setattr("uplift.extras.images.image.MAX_BAND_BYTES", band)
    numbers = np.random.default_rng(1).integers(0, 3, SHAPE, dtype=np.uint8)
    found = converted(cubes, png(tmp_path / "ids.png", numbers))
    for number, cube in enumerate(cubes):
        rows = numbers == number
        assert_allclose(found[rows], spectra(cube, colours)[rows], atol=2e-6)
    assert np.abs(spectra(cubes[0], colours) - spectra(cubes[1], colours)).max() > 0.05


@pytest.mark.parametrize("kind", ["png", "png16", "exr"])
def test_grey_mixes_two_cubes(converted, cubes, colours, tmp_path, sensor, kind):
    ramp = np.tile(np.linspace(0, 1, SHAPE[1]), (SHAPE[0], 1))
    if kind == "exr":
        mask = write_exr(tmp_path / "mask.exr", {"Y": ramp.astype(np.float32)})
    else:
        dtype, white = (np.uint8, 255) if kind == "png" else (np.uint16, 65535)
        codes = np.rint(ramp * white).astype(dtype)
        ramp = codes / white
        mask = png(tmp_path / "mask.png", codes)
    found = converted(cubes[:2], mask)
    one, two = (spectra(cube, colours) for cube in cubes[:2])
    assert_allclose(
        found, (1 - ramp)[..., None] * one + ramp[..., None] * two, atol=3e-6
    )


def test_colours_are_weights_of_three_cubes(converted, cubes, colours, tmp_path):
    codes = np.random.default_rng(3).integers(1, 256, (*SHAPE, 3), dtype=np.uint8)
    found = converted(cubes, png(tmp_path / "mask.png", codes))
    weights = codes / codes.sum(axis=-1, keepdims=True)
    expected = sum(
        weights[..., k, None] * spectra(cube, colours) for k, cube in enumerate(cubes)
    )
    assert_allclose(found, expected, atol=3e-6)


def test_moments_and_multipliers_mix_as_reflectances_do(
    converted, cubes, colours, tmp_path, sensor
):
    mask = png(tmp_path / "mask.png", np.tile(np.uint8([0, 128, 255]), (SHAPE[0], 10)))
    found = converted(cubes[:2], mask, texture.Moments())
    model = cubes[0].data.model
    parts = [
        cube.coefficients(colours.reshape(-1, 3)).reshape(*SHAPE, -1)[:, 1::3]
        for cube in cubes[:2]
    ]
    share = 128 / 255
    assert_allclose(
        found[:, 1::3], (1 - share) * parts[0] + share * parts[1], atol=1e-5
    )
    # Multipliers are exact in colour, and those of one cube where the mask is black.
    found = converted(cubes[:2], mask, texture.Multipliers()).astype(float)
    spectrum = evaluate(model, found.reshape(-1, 9), sensor.wavelengths)
    assert_allclose(sensor.rgb(spectrum).reshape(*SHAPE, 3), colours, atol=2e-4)
    alone = texture.prepare(cubes[0], texture.Multipliers(), threads=1).pixels.sample(
        colours[:, ::3]
    )
    assert_array_equal(found[:, ::3], alone)


@pytest.mark.parametrize(
    ("values", "count"),
    [
        (np.zeros((20, 29), np.uint8), 2),
        (
            np.full(SHAPE, 2, np.uint8),
            2,
        ),  # a number too large, or weights that are nearly black
        (np.full(SHAPE, 255, np.uint8), 3),
        (np.zeros((*SHAPE, 3), np.uint8) + np.uint8([1, 0, 0]), 2),
        (
            np.eye(20, 30, dtype=np.uint8)[..., None] * np.uint8([9, 0, 0]),
            3,
        ),  # black pixels
        *(
            (np.full(SHAPE, value, np.float32), 2)
            for value in (np.nan, -0.1, 1.1, np.inf)
        ),
    ],
)
def test_masks_that_do_not_fit_are_refused(image, cubes, tmp_path, values, count):
    mask = tmp_path / "mask.exr"
    mask = (
        write_exr(mask, {"Y": values})
        if values.dtype == np.float32
        else png(mask.with_suffix(".png"), values)
    )
    with raises(TextureError) as caught:
        texture.convert(prepared(cubes[:count], mask), image, tmp_path / "out.exr")
    assert caught.value.path == mask
    assert not (tmp_path / "out.exr").exists()


def test_cubes_that_do_not_fit_are_refused(cubes, small_sigmoid_cube, tmp_path):
    mask = png(tmp_path / "mask.png", np.zeros(SHAPE, np.uint8))
    for others, encoding, code in (
        ((), SPECTRUM, "option"),
        ((small_sigmoid_cube,), texture.Multipliers(), "option"),
        ((uplift.load("ACEScg"),), SPECTRUM, "cubes-of-different-spaces"),
    ):
        with raises(OptionError, code):
            prepared((cubes[0], *others), mask, encoding)
    with raises(TextureError, "file-not-found"):
        prepared(cubes[:2], tmp_path / "none.png")


@pytest.mark.parametrize(
    "encoding", [SPECTRUM, texture.Moments(), texture.Multipliers()]
)
def test_an_entry_outside_the_space_answers_where_its_cube_is_chosen(
    cyan_cube, plain_cube, tmp_path, encoding
):
    """Three pixels of its colour: of its cube, of one without it, and half of each."""
    boxes = cyan_cube.data.outside_boxes
    data = plain_cube.data
    rgb = np.tile(boxes.rgb[0], (1, 3, 1)).astype(np.float32)
    image = write_exr(tmp_path / "cyan.exr", planes(rgb))
    mask = write_exr(
        tmp_path / "weights.exr", {"Y": np.array([[0, 1, 0.5]], dtype=np.float32)}
    )
    converter = prepared((cyan_cube, plain_cube), mask, encoding)
    result = texture.convert(converter, image, tmp_path / "out.exr")
    assert [each.code for each in result.warnings] == ["pixels-out-of-gamut"]
    (colours,), (numbers,) = (
        read_channels(result.target, names) for names in ("RGB", converter.channels)
    )
    clipped = boxes.rgb[0].clip(0, 1)
    assert_allclose(
        colours, [boxes.rgb[0], clipped, (boxes.rgb[0] + clipped) / 2], atol=1e-6
    )
    alone = [
        each.numbers(colours[None, [row]])[1][0, 0]
        for row, each in enumerate(converter.uplifters)
    ]
    assert_allclose(numbers[:2], alone, atol=1e-6)
    if encoding.name != "multipliers":
        assert_allclose(numbers[2], np.mean(alone, axis=0), atol=1e-6)
    else:
        spectrum = evaluate(
            data.model, numbers[[2]].astype(float), data.sensor.wavelengths
        )
        assert_allclose(data.sensor.rgb(spectrum)[0], colours[2], atol=1e-4)
