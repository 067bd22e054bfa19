"""Spectra of colours and of lights: what other readers evaluate from a texture
reproduces the image.
"""

import json
import warnings

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.extras.texture.conftest import (
    channels,
    planes,
    read_channels,
    rgb_of,
    write_image,
)
from tests.helpers import raises
from uplift import models
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import UpliftError
from uplift.extras import texture
from uplift.extras.emission.lookup import EmissionTable, load_emission

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from colour.io.fichet2021 import (
        components_to_sRGB_Fichet2021,
        read_spectral_image_Fichet2021,
    )


@pytest.mark.filterwarnings("ignore::colour.utilities.ColourRuntimeWarning")
@pytest.mark.parametrize(("depth", "within"), [("float", 1e-6), ("half", 3e-4)])
def test_colour_science_reads_reflectances_of_the_image(
    depth, within, colours, small_cube, to_texture
):
    uplifter = texture.prepare(small_cube, depth=depth)
    target = to_texture(planes(colours), uplifter).target
    components, specification = read_spectral_image_Fichet2021(
        target, additional_data=True
    )
    assert not specification.is_emissive
    ((at, found),) = components.values()
    assert_array_equal(at, small_cube.wavelengths)
    assert_allclose(found, small_cube.reflectance(colours), rtol=0, atol=within)
    rgb, _ = components_to_sRGB_Fichet2021({"T": (at, found.astype(float))})
    assert delta_e_rgb(small_cube.data.sensor, colours, rgb).mean() < 0.1


@pytest.mark.parametrize("cube", ["small_cube", "small_sigmoid_cube"])
def test_multipliers_evaluate_to_the_exact_colour(cube, colours, to_texture, request):
    """By nothing but the file."""
    cube = request.getfixturevalue(cube)
    sensor = cube.data.sensor
    uplifter = texture.prepare(cube, texture.Multipliers(), depth="float")
    result = to_texture(planes(colours), uplifter)
    header = OpenEXR.File(str(result.target), header_only=True).parts[0].header
    model = models.from_description(json.loads(header["uplift.model"]))
    names = [f"multiplier.{index:02}" for index in range(model.count)]
    multipliers = read_channels(result.target, names).astype(float)
    spectra = model.to_reflectance(multipliers @ model.basis(sensor.wavelengths).T)
    back = sensor.rgb(spectra)
    assert np.median(np.abs(back - colours)) < 1e-6
    assert delta_e_rgb(sensor, back, colours).mean() < 5e-3


@pytest.mark.parametrize(
    ("cube", "encoding", "options", "code"),
    [
        ("small_sigmoid_cube", texture.Moments(), {}, "option"),
        ("small_cube", texture.Multipliers(), {"depth": "half"}, "option"),
        ("small_cube", None, {"encoding": "log"}, "unknown-name"),
        ("small_cube", None, {"out_of_gamut": "squash"}, "unknown-name"),
        ("small_cube", texture.Spectrum((500.0, 500.0 + 1e-8)), {}, "option"),
        ("small_cube", texture.Spectrum((-5.0,)), {}, "option"),
    ],
)
def test_impossible_settings_raise(cube, encoding, options, code, request):
    with raises(UpliftError, code):
        texture.prepare(request.getfixturevalue(cube), encoding, **options)


def test_unrealisable_pixels_are_counted(colours, to_texture):
    """Only they are, not all pixels around unrealisable nodes."""
    wide = uplift.load("ACEScg")
    uplifter = texture.prepare(wide, texture.Moments(), threads=1)
    counts = to_texture(planes(colours), uplifter).counts
    distance = wide.data.solid.signed_distance(colours.reshape(-1, 3))
    outside = distance > wide.data.threshold
    assert 0 < counts["pixels-unrealisable"] == outside.sum() < colours.size / 6
    assert counts.warnings()[0].code == "pixels-unrealisable"


@pytest.fixture(scope="module")
def table() -> EmissionTable:
    return load_emission()


@pytest.fixture(scope="module")
def lights(table):
    return texture.prepare_lights(table, threads=1)


@pytest.fixture
def sky():
    """Linear RGB (4, 5, 3), float32, with a sun of 1e5, a negative component, and
    black.
    """
    rgb = np.random.default_rng(0).uniform(0.2, 1.3, (4, 5, 3)).astype(np.float32)
    rgb[0, 1] = (1e5, 9e4, 6e4)
    rgb[2, 3] = (-0.05, 0.6, 0.5)
    rgb[3, 3] = 0
    return rgb


def power_of(conversion):
    """Spectral channels (h, w, N) of a texture of lights."""
    found = channels(conversion.target)
    names = sorted(name for name in found if name.startswith("S0"))
    return np.stack([found[name] for name in names], axis=-1).astype(float)


@pytest.mark.parametrize(
    ("depth", "scale", "limit"), [("float", 1, 0.001), ("half", 1 / 8, 0.05)]
)
def test_colour_science_reads_spectra_of_the_colours_of_the_image(
    table, sensor, sky, to_texture, depth, scale, limit
):
    sky = sky * np.float32(scale)
    converter = texture.prepare_lights(table, depth=depth, threads=1)
    conversion = to_texture(planes(sky), converter)
    assert conversion.warnings == ()
    components, specification = read_spectral_image_Fichet2021(
        conversion.target, additional_data=True
    )
    assert specification.is_emissive
    ((at, power),) = components.values()
    assert_array_equal(at, table.wavelengths)
    assert power.min() >= 0
    # ΔE00 ends at white.
    largest = np.maximum(sky.max(axis=-1, keepdims=True), 1e-6)
    found = table.rgb(power.astype(float))
    assert delta_e_rgb(sensor, sky / largest, found / largest).max() < limit


@pytest.mark.parametrize("kind", ["LatLong Environment", "CubeFace Environment"])
def test_an_environment_map_stays_one(lights, to_texture, tmp_path, kind):
    shape = (24, 4, 3) if kind.startswith("Cube") else (4, 8, 3)
    pixels = np.full(shape, 0.5, np.float32)
    source = write_image(tmp_path / "sky.exr", pixels, textureformat=kind)
    result = to_texture(source, lights)
    found = OpenImageIO.ImageInput.open(str(result.target)).spec()
    assert found.get_string_attribute("textureformat") == kind
    assert found.get_string_attribute("emissiveUnits") == "W.m^-2.sr^-1"


def test_colours_that_no_light_has_are_moved_and_counted(table, lights, to_texture):
    """Alpha passes through and divides nothing."""
    rgb = np.array(
        [[[0.5, 5, 0.5], [-3, 1, -2], [np.nan, 1, 1], [np.inf, 0, 0], [1e31, 0, 0]]],
        np.float32,
    )
    alpha = np.array([[0.5, 0, 1, 1, 1]], np.float32)
    conversion = to_texture({**planes(rgb), "A": alpha}, lights)
    assert_array_equal(channels(conversion.target)["A"], alpha)
    assert conversion.counts["pixels-not-lights"] == 1
    assert conversion.counts["pixels-not-finite"] == 3
    assert len(conversion.warnings) == 2
    power = power_of(conversion)
    found = table.rgb(power)
    assert_allclose(found[0, 0], rgb[0, 0], rtol=1e-5)
    luminance = table.xyz(rgb[0, 1].astype(float))[1]
    assert_allclose(table.xyz(found[0, 1])[1], max(luminance, 0), rtol=1e-5, atol=1e-6)
    stored = rgb_of(conversion)
    assert table.contains(stored[0, 1].astype(float) * (1 - 1e-6)).all()
    assert_allclose(stored, found, rtol=1e-4, atol=1e-3)


def test_half_floats_end_at_their_largest(table, to_texture):
    rgb = np.array([[[1e5, 1e5, 1e5], [1, 1, 1]]], np.float32)
    converter = texture.prepare_lights(table, depth="half", threads=1)
    conversion = to_texture(planes(rgb), converter)
    assert [each.code for each in conversion.warnings] == ["pixels-too-bright"]
    assert conversion.counts["pixels-too-bright"] == 1
    assert power_of(conversion)[0, 0].max() == 65504


def test_floats_of_lights_are_linear(table, sky, to_texture):
    with raises(UpliftError, "option"):
        to_texture(planes(sky), texture.prepare_lights(table, encoding="encoded"))
