"""Images of lights: what other readers find in a texture are the colours of the image, at any brightness."""

from __future__ import annotations

import warnings

import numpy as np
import OpenImageIO
import pytest

from tests.helpers import raises
from tests.io.texture.conftest import channels, planes, read_channels, write_exr, write_image
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import OptionError
from uplift.io import texture
from uplift.lights.lookup import EmissionTable, load_emission

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from colour.io.fichet2021 import read_spectral_image_Fichet2021


@pytest.fixture(scope="module")
def table() -> EmissionTable:
    return load_emission()


@pytest.fixture(scope="module")
def lights(table):
    return texture.prepare_lights(table, threads=1)


@pytest.fixture
def sky():
    """Linear RGB (20, 30, 3), float32: a gradient, a sun of 1e5, a negative component, and black."""
    rows, columns = np.mgrid[0:20, 0:30]
    rgb = np.stack([0.2 + rows / 40, 0.4 + rows / 60, 1.3 - rows / 20 + columns / 300], axis=-1)
    rgb[3:5, 4:6] = (1e5, 9e4, 6e4)
    rgb[10, 10], rgb[12, 12] = (-0.05, 0.6, 0.5), 0.0
    return rgb.astype(np.float32)


def spectral_channels(path):
    found = channels(path)
    return np.stack([found[name] for name in sorted(found) if name.startswith("S0")], axis=-1)


def largest_difference(sensor, rgb, found):
    """Largest ΔE00 after each pixel is scaled to a largest component of 1, as ΔE00 ends at white."""
    scale = np.maximum(rgb.max(axis=-1, keepdims=True), 1e-6)
    return delta_e_rgb(sensor, rgb / scale, found / scale).max()


@pytest.mark.parametrize(("depth", "scale", "limit"), [("float", 1, 0.001), ("half", 1 / 8, 0.05)])
def test_colour_science_reads_spectra_of_the_colours_of_the_image(table, sensor, sky, tmp_path, depth, scale, limit):
    path = write_exr(tmp_path / "sky.exr", planes(sky * np.float32(scale)))
    conversion = texture.convert(texture.prepare_lights(table, depth=depth, threads=1), path, tmp_path / "out.exr")
    assert conversion.warnings == ()
    components, specification = read_spectral_image_Fichet2021(tmp_path / "out.exr", additional_data=True)
    assert specification.is_emissive
    ((at, power),) = components.values()
    np.testing.assert_array_equal(at, table.wavelengths)
    assert power.min() >= 0
    assert largest_difference(sensor, sky * scale, table.rgb(power.astype(float))) < limit


@pytest.mark.parametrize("kind", ["LatLong Environment", "CubeFace Environment"])
def test_an_environment_map_stays_one(lights, tmp_path, kind):
    height, width = (24, 4) if kind.startswith("Cube") else (4, 8)
    source = write_image(tmp_path / "sky.exr", np.full((height, width, 3), 0.5, np.float32), textureformat=kind)
    texture.convert(lights, source, tmp_path / "out.exr")
    found = OpenImageIO.ImageInput.open(str(tmp_path / "out.exr")).spec()
    assert found.get_string_attribute("textureformat") == kind
    assert found.get_string_attribute("emissiveUnits") == "W.m^-2.sr^-1"


def test_a_radiance_picture_is_read(table, sky, tmp_path):
    positive = np.abs(sky)
    source = write_image(tmp_path / "sky.hdr", positive)
    # The file names no primaries.
    texture.convert(texture.prepare_lights(table, space="sRGB", threads=1), source, tmp_path / "out.exr")
    found = table.rgb(spectral_channels(tmp_path / "out.exr").astype(float))
    largest = np.maximum(positive.max(axis=-1, keepdims=True), 1e-9)
    np.testing.assert_allclose(found / largest, positive / largest, rtol=0, atol=0.01)


def test_what_no_light_has_is_moved_and_counted(table, lights, tmp_path):
    rgb = np.array([[[0.5, 0.5, 0.5], [-3, 1, -2], [np.nan, 1, 1], [np.inf, 0, 0], [1e31, 0, 0]]], np.float32)
    conversion = texture.convert(lights, write_exr(tmp_path / "a.exr", planes(rgb)), tmp_path / "out.exr")
    assert (conversion.counts.not_lights, conversion.counts.not_finite) == (1, 3)
    assert [each.code for each in conversion.warnings] == ["pixels-not-finite", "pixels-not-lights"]
    power = spectral_channels(tmp_path / "out.exr")
    assert np.isfinite(power).all()
    luminance = table.xyz(rgb[0, 1].astype(float))[1]
    xyz = table.xyz(table.rgb(power[0, 1].astype(float)))
    np.testing.assert_allclose(xyz[1], max(luminance, 0), rtol=1e-5, atol=1e-6)
    stored = read_channels(tmp_path / "out.exr", "RGB")
    assert table.contains(stored[0, 1].astype(float) * (1 - 1e-6)).all()
    np.testing.assert_allclose(stored, table.rgb(power.astype(float)), rtol=1e-4, atol=1e-3)


def test_half_floats_end_at_their_largest(table, tmp_path):
    rgb = np.array([[[1e5, 1e5, 1e5], [1, 1, 1]]], np.float32)
    converter = texture.prepare_lights(table, depth="half", threads=1)
    conversion = texture.convert(converter, write_exr(tmp_path / "a.exr", planes(rgb)), tmp_path / "out.exr")
    assert [(each.code, conversion.counts.too_bright) for each in conversion.warnings] == [("pixels-too-bright", 1)]
    assert spectral_channels(tmp_path / "out.exr")[0, 0].max() == 65504


def test_alpha_passes_through_and_divides_nothing(table, lights, tmp_path):
    rgb = np.array([[[0.2, 0.3, 0.4], [5, 5, 5]]], np.float32)
    alpha = np.array([[0.5, 0.0]], np.float32)
    path = write_exr(tmp_path / "glow.exr", {**planes(rgb), "A": alpha})
    conversion = texture.convert(lights, path, tmp_path / "out.exr")
    assert conversion.warnings == ()
    np.testing.assert_array_equal(channels(tmp_path / "out.exr")["A"], alpha)
    np.testing.assert_allclose(table.rgb(spectral_channels(tmp_path / "out.exr")), rgb, rtol=1e-5)


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"depth": "uint"}, "unsupported-depth"),
        ({"encoding": "log"}, "option"),
        ({"wavelengths": [500, 400]}, "option"),
        ({"wavelengths": [np.nan]}, "invalid-wavelengths"),
        ({"encoding": "encoded"}, "option"),  # floats of lights are linear
    ],
)
def test_invalid_options_are_refused(table, sky, tmp_path, options, code):
    path = write_exr(tmp_path / "sky.exr", planes(sky))
    with raises(OptionError, code):
        texture.convert(texture.prepare_lights(table, **options), path, tmp_path / "out.exr")
    assert not (tmp_path / "out.exr").exists()
