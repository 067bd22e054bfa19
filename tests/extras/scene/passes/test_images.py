"""Textures and lights of passes, and pictures that are decoded."""

import json
from shutil import copyfile

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.extras.scene.passes.conftest import SIX
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import (
    OptionError,
    OutputError,
    PassesError,
    UnknownNameError,
    UpliftError,
)
from uplift.extras import texture
from uplift.extras.scene import passes as library
from uplift.extras.scene.passes.textures import ATTRIBUTE, pass_mark

SIZE = (40, 30)
"""Width and height of pictures, which are several tiles."""


@pytest.fixture
def write(tmp_path):
    """Write channels (height, width) as OpenEXR, and return the path."""

    def write(name, channels, header=None, tile=0):
        path = tmp_path / name
        first = next(iter(channels.values()))
        height, width = first.shape
        kind = "half" if first.dtype == np.float16 else "float"
        spec = OpenImageIO.ImageSpec(width, height, len(channels), kind)
        spec.channelnames = tuple(channels)
        for key, value in (header or {}).items():
            spec.attribute(key, value)
        if tile:
            spec.tile_width = tile
            spec.tile_height = tile
        output = OpenImageIO.ImageOutput.create(str(path))
        assert output.open(str(path), spec)
        pixels = np.stack([*channels.values()], axis=-1).astype(np.float32)
        assert output.write_image(pixels)
        output.close()
        return path

    return write


@pytest.fixture
def numbers():
    """Numbers (height, width, 6) of a picture in all passes."""
    return np.random.default_rng(3).random((*SIZE[::-1], 6)).astype(np.float32)


@pytest.fixture
def pictures(write, numbers):
    """Pictures of two passes, the first of which has alpha and depth."""

    def pictures(header=None, tile=0, others=True, names=("a.1.exr", "a.2.exr")):
        paths = []
        for number, name in enumerate(names):
            bands = np.moveaxis(numbers[..., 3 * number : 3 * number + 3], -1, 0)
            channels = dict(zip("RGB", bands, strict=True))
            if number == 0 and others:
                channels["A"] = np.full(SIZE[::-1], 0.5, np.float32)
                channels["Z"] = np.arange(40 * 30, dtype=np.float32).reshape(30, 40)
            paths.append(write(name, channels, header, tile))
        return paths

    return pictures


def read(path):
    """Return the channels of an OpenEXR file by name, and its header."""
    file = OpenEXR.File(str(path), separate_channels=True)
    channels = {name: channel.pixels for name, channel in file.channels().items()}
    return channels, file.header()


@pytest.mark.parametrize("tile", [0, 16, 64])
def test_decoding_is_a_matrix(two_passes, pictures, numbers, tmp_path, tile):
    decoder = library.decoder(two_passes, space="XYZ")
    target = tmp_path / "xyz.exr"
    decoded = library.decode_pictures(decoder, pictures(tile=tile), target)
    channels, _ = read(target)
    expected = numbers @ two_passes.to_xyz.T
    found = np.stack([channels[name] for name in "XYZ"], axis=-1)
    assert_allclose(found, expected, rtol=1e-5, atol=1e-6)
    assert_allclose(channels["A"], 0.5)
    assert_allclose(channels["first.Z"].ravel(), np.arange(1200))
    assert decoded.counts.pixels == 1200
    assert not decoded.warnings


def test_white_of_each_space(two_passes):
    for space in ("sRGB", "ACEScg", "ITU-R BT.2020"):
        for light in two_passes.lights:
            decoder = library.decoder(
                two_passes, space=space, light=light.name, white=light.name
            )
            assert_allclose(decoder.matrix @ light.numbers, 1, atol=0.02)
    plain = library.decoder(two_passes)
    numbers = two_passes.light("A").numbers
    red, _, blue = plain.matrix @ numbers
    assert red > 1.5
    assert blue < 0.4
    assert_allclose(plain.matrix @ two_passes.light("D65").numbers, 1, atol=0.02)


def test_header_states_the_primaries(two_passes, pictures, tmp_path):
    target = tmp_path / "aces.exr"
    decoder = library.decoder(two_passes, space="ACEScg")
    library.decode_pictures(decoder, pictures(), target)
    _, header = read(target)
    assert_allclose(header["chromaticities"][:2], (0.713, 0.293), atol=1e-3)
    assert_allclose(header["chromaticities"][6:], (0.32168, 0.33767), atol=1e-3)
    assert json.loads(header["uplift.texture"])["space"] == "ACEScg"


def test_negative_numbers_are_counted(two_passes, write, tmp_path):
    values = np.full((4, 5, 3), 0.5, np.float32)
    values[0, 0, 0] = -0.1
    values[1, 1] = np.nan
    values[2, 2, 2] = -1e-6
    first = write("a.1.exr", dict(zip("RGB", np.moveaxis(values, -1, 0), strict=True)))
    plain = np.full((4, 5), 0.5, np.float32)
    second = write("a.2.exr", dict.fromkeys("RGB", plain))
    decoder = library.decoder(two_passes)
    target = tmp_path / "a.exr"
    decoded = library.decode_pictures(decoder, [first, second], target)
    assert decoded.counts["pixels-negative"] == 2
    assert decoded.counts["pixels-not-finite"] == 1
    codes = sorted(warning.code for warning in decoded.warnings)
    assert codes == ["pixels-negative", "pixels-not-finite"]
    channels, _ = read(target)
    assert all(np.isfinite(channel).all() for channel in channels.values())


def test_half_floats_hold_finite_numbers(two_passes, write, tmp_path):
    plane = np.full((4, 5), 0.5, np.float32)
    plane[0, :2] = (np.inf, 3e5)
    far = {"Z": np.full((4, 5), 1e9, np.float32), "A": np.full((4, 5), np.inf, np.half)}
    sources = [write("a.1.exr", dict.fromkeys("RGB", plane) | far)]
    sources.append(write("a.2.exr", dict.fromkeys("RGB", plane)))
    decoder = library.decoder(two_passes, space="XYZ")
    target = tmp_path / "a.exr"
    decoded = library.decode_pictures(decoder, sources, target, depth="half")
    found, _ = read(target)
    assert decoded.counts["pixels-too-bright"] == 2
    assert found["Y"].max() == np.half(65504)
    assert_allclose(found["first.Z"], 1e9)
    assert np.isinf(found["A"]).all()


@pytest.mark.parametrize(
    ("second", "code"),
    [
        ("same", "passes-repeated"),
        ("link", "passes-repeated"),
        ("copy", "passes-repeated"),
        ("black", "passes-black"),
        ("srgb_rec709_scene", "passes-not-linear"),
    ],
)
def test_pictures_are_of_different_passes(
    two_passes, pictures, write, tmp_path, second, code
):
    header = {"colorInteropID": second if "_" in second else "lin_ap1_scene"}
    sources = pictures(header, others=False, names=("a.1.exr", "b.exr"))
    target = tmp_path / "out.exr"
    decoder = library.decoder(two_passes)
    if second == "same":
        sources[1] = sources[0]
    elif second == "link":
        sources[1] = tmp_path / "c.exr"
        sources[1].symlink_to(sources[0])
    elif second == "copy":
        copyfile(*sources)
    elif second == "black":
        write("b.exr", dict.fromkeys("RGB", np.zeros(SIZE[::-1], np.float32)))
    with raises(PassesError, code):
        library.decode_pictures(decoder, sources, target, force=True)


def test_number_of_pictures(two_passes, pictures, tmp_path):
    decoder = library.decoder(two_passes)
    paths = pictures()
    for sources in (paths[:1], [*paths, paths[0]], []):
        with raises(PassesError, "passes-missing"):
            library.decode_pictures(decoder, sources, tmp_path / "a.exr")


def test_order_of_pictures(two_passes, pictures, tmp_path):
    decoder = library.decoder(two_passes)
    with raises(PassesError, "passes-out-of-order"):
        library.decode_pictures(decoder, pictures()[::-1], tmp_path / "a.exr")


def test_pictures_carry_their_passes(two_passes, pictures, tmp_path):
    decoder = library.decoder(two_passes)
    target = tmp_path / "a.exr"
    second = {ATTRIBUTE: pass_mark(two_passes, 2)}
    with raises(PassesError, "passes-out-of-order") as caught:
        library.decode_pictures(decoder, pictures(second), target)
    assert caught.value.path.name == "a.1.exr"
    with raises(PassesError, "passes-differ"):
        library.decode_pictures(decoder, pictures({ATTRIBUTE: "0 1 of 2"}), target)
    assert not target.exists()


@pytest.mark.parametrize(
    ("names", "width", "code"),
    [
        ("RGB", 39, "passes-sizes-differ"),
        ("XYZ", 40, "passes-not-linear"),
        ("Y", 40, "passes-not-linear"),
        ("Z", 40, "texture"),
    ],
)
def test_pictures_that_do_not_fit_are_refused(
    two_passes, pictures, write, tmp_path, names, width, code
):
    first, _ = pictures()
    second = write("b.2.exr", dict.fromkeys(names, np.ones((30, width), np.float32)))
    decoder = library.decoder(two_passes)
    with raises(UpliftError, code) as caught:
        library.decode_pictures(decoder, [first, second], tmp_path / "a.exr")
    assert caught.value.path == second


def test_encoded_pictures_are_refused(two_passes, pictures, tmp_path):
    from PIL import Image

    first, _ = pictures()
    path = tmp_path / "b.2.png"
    Image.fromarray(np.zeros((30, 40, 3), np.uint8)).save(path)
    decoder = library.decoder(two_passes)
    with raises(PassesError, "passes-not-linear"):
        library.decode_pictures(decoder, [first, path], tmp_path / "a.exr")


def test_pictures_are_not_replaced(two_passes, pictures, tmp_path):
    decoder = library.decoder(two_passes)
    paths = pictures()
    with raises(OutputError, "output-is-input"):
        library.decode_pictures(decoder, paths, paths[0], force=True)
    target = tmp_path / "a.exr"
    target.write_text("kept")
    with raises(OutputError, "file-exists"):
        library.decode_pictures(decoder, paths, target)
    assert target.read_text() == "kept"


def test_spaces_must_be_linear(two_passes):
    with raises(OptionError):
        library.decoder(two_passes, space="ARRI LogC4")
    with raises(UnknownNameError):
        library.decoder(two_passes, space="sRBG")
    with raises(UnknownNameError):
        library.decoder(two_passes, light="FL2")


@pytest.fixture(scope="module")
def cube():
    """The packaged cube."""
    return uplift.load()


def test_textures_are_band_averages(two_passes, cube, write, tmp_path):
    rgb = np.random.default_rng(5).random((6, 7, 3)).astype(np.float32)
    source = write("in.exr", dict(zip("RGB", np.moveaxis(rgb, -1, 0), strict=True)))
    spectra = cube.reflectance(rgb.astype(float), observer.grid())
    expected = spectra @ SIX.weights.T
    for number in (1, 2):
        converter = library.prepare_pass(cube, two_passes, number)
        target = tmp_path / f"out.{number}.exr"
        texture.convert(converter, source, target)
        channels, header = read(target)
        assert "chromaticities" not in header
        assert header[ATTRIBUTE] == pass_mark(two_passes, number)
        found = np.stack([channels[name] for name in "RGB"], axis=-1)
        assert found.dtype == np.float16
        rows = slice(3 * number - 3, 3 * number)
        assert_allclose(found, expected[..., rows], atol=1e-3)


def test_environment_maps_are_numbers_of_lights(two_passes, write, tmp_path):
    table = uplift.load_emission()
    rgb = np.array([[[3.0, 3, 3], [30, 22, 9], [0.2, 0.5, 2]]], np.float32)
    source = write("sky.exr", dict(zip("RGB", np.moveaxis(rgb, -1, 0), strict=True)))
    found = []
    for number in (1, 2):
        converter = library.prepare_light_pass(table, two_passes, number)
        target = tmp_path / f"sky.{number}.exr"
        texture.convert(converter, source, target)
        channels, _ = read(target)
        found.append(np.stack([channels[name] for name in "RGB"], axis=-1))
    decoded = np.concatenate(found, axis=-1) @ two_passes.to_xyz.T
    expected = rgb.reshape(-1, 3) @ observer.sensor().rgb_to_xyz.T
    white = expected[:, 1:2] * observer.light("D65").white
    decoded = decoded.reshape(-1, 3)
    assert delta_e_2000(lab(decoded, white), lab(expected, white)).max() < 1


def test_passes_of_another_cube_are_refused(two_passes, cube):
    from dataclasses import replace

    other = replace(two_passes, origin={**two_passes.origin, "cube": "0" * 64})
    with raises(PassesError, "passes-of-another-cube"):
        library.prepare_pass(cube, other, 1)
    for number in (0, 3):
        with raises(OptionError):
            library.prepare_pass(cube, two_passes, number)


def test_rendering_by_passes_has_the_colours_of_spectra(two_passes, cube):
    """Light that three painted surfaces reflect, one after the other."""
    painted = np.array([[0.7, 0.3, 0.1], [0.6, 0.6, 0.2], [0.5, 0.6, 0.7]])
    spectra = cube.reflectance(painted, observer.grid())
    for light in two_passes.lights:
        truth = observer.light(light.name)
        xyz = truth.xyz @ spectra.prod(axis=0)
        numbers = two_passes.reflectance_numbers(spectra).prod(axis=0)
        decoded = light.to_xyz @ (numbers * light.numbers)
        error = delta_e_2000(lab(decoded, truth.white), lab(xyz, truth.white))
        assert error < 1
