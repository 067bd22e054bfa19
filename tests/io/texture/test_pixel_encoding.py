"""Pixel encodings: what other readers evaluate from a texture reproduces the image."""

from __future__ import annotations

import json
import warnings
from dataclasses import replace

import numpy as np
import OpenEXR
import pytest

from tests.helpers import raises, with_points
from tests.io.texture.conftest import PHOTO, WAVELENGTHS, planes, read_channels, write_exr
from uplift import models
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import OptionError
from uplift.cube import digest
from uplift.io import texture

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from colour.io.fichet2021 import components_to_sRGB_Fichet2021, read_spectral_image_Fichet2021


@pytest.fixture(scope="module")
def photo(tmp_path_factory, small_cube):
    """Crop of a photograph as 8-bit PNG, and its linear RGB."""
    from PIL import Image

    path = tmp_path_factory.mktemp("photo") / "photo.png"
    corner = Image.open(PHOTO).convert("RGB").crop((200, 60, 264, 124))
    corner.save(path)
    return path, small_cube.decode(np.asarray(corner, dtype=float))


@pytest.mark.filterwarnings("ignore::colour.utilities.ColourRuntimeWarning")
@pytest.mark.parametrize(("depth", "max_error", "within"), [("float", 0.02, 1e-6), ("half", 0.1, 3e-4)])
def test_colour_science_reads_the_photograph_from_a_spectral_image(
    photo, small_cube, tmp_path, depth, max_error, within
):
    path, linear = photo
    texture.convert(texture.prepare(small_cube, depth=depth), path, tmp_path / "out.exr")
    components, specification = read_spectral_image_Fichet2021(tmp_path / "out.exr", additional_data=True)
    assert not specification.is_emissive
    ((at, found),) = components.values()
    np.testing.assert_array_equal(at, small_cube.data.sensor.wavelengths)
    rgb, _ = components_to_sRGB_Fichet2021({"T": (at, found.astype(float))})
    assert delta_e_rgb(small_cube.data.sensor, linear, rgb).mean() < max_error
    np.testing.assert_allclose(found, small_cube.reflectance(linear), rtol=0, atol=within)


def evaluated(path, prefix):
    """Return reflectance as a function of wavelength, from nothing but the file."""
    header = OpenEXR.File(str(path), header_only=True).parts[0].header
    model = models.from_description(json.loads(header["uplift.model"]))
    values = read_channels(path, [f"{prefix}.{index:02}" for index in range(model.count)]).astype(float)
    multipliers = model.from_storage(values) if prefix == "moment" else values
    return lambda at: model.to_reflectance(multipliers @ model.basis(at).T)


@pytest.mark.parametrize("cube", ["small_cube", "small_sigmoid_cube"])
def test_multipliers_evaluate_to_the_exact_colour(cube, photo, tmp_path, request):
    cube = request.getfixturevalue(cube)
    texture.convert(texture.prepare(cube, texture.Multipliers()), photo[0], tmp_path / "out.exr")
    sensor = cube.data.sensor
    back = sensor.rgb(evaluated(tmp_path / "out.exr", "multiplier")(sensor.wavelengths))
    assert np.median(np.abs(back - photo[1])) < 1e-6
    assert delta_e_rgb(sensor, back, photo[1]).mean() < 5e-3


def test_moments_are_those_of_the_cube(small_cube, colours, tmp_path):
    source = write_exr(tmp_path / "in.exr", planes(colours))
    texture.convert(texture.prepare(small_cube, texture.Moments()), source, tmp_path / "out.exr")
    names = [f"moment.{index:02}" for index in range(9)]
    expected = small_cube.coefficients(colours)
    np.testing.assert_allclose(read_channels(tmp_path / "out.exr", names), expected, rtol=0, atol=1e-6)
    at = small_cube.data.sensor.wavelengths
    answer = small_cube.reflectance(colours[1:].astype(float), mode="moments")
    found = evaluated(tmp_path / "out.exr", "moment")(at)[1:]
    assert np.median(np.abs(found - answer)) < 1e-5


def test_the_header_identifies_the_cube_and_the_settings(spectral, small_cube, colours, tmp_path):
    texture.convert(spectral, write_exr(tmp_path / "in.exr", planes(colours)), tmp_path / "out.exr")
    header = OpenEXR.File(str(tmp_path / "out.exr"), header_only=True).parts[0].header
    assert (header["uplift.space"], header["uplift.illuminant"]) == ("sRGB", "D65")
    assert header["uplift.cube"] == digest(small_cube.data)
    settings = {"as": "spectrum", "depth": "float", "encoding": "auto", "out_of_gamut": "clip"}
    assert json.loads(header["uplift.texture"]) == {**settings, "wavelengths": list(WAVELENGTHS)}
    srgb = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329]
    np.testing.assert_allclose(header["chromaticities"], srgb, atol=2e-4)


@pytest.mark.parametrize(
    ("cube", "encoding", "options", "code"),
    [
        ("small_sigmoid_cube", texture.Moments(), {}, "no-moments"),
        ("small_cube", texture.Multipliers(), {"depth": "half"}, "unsupported-depth"),
        ("small_cube", None, {"encoding": "log"}, "option"),
        ("small_cube", None, {"out_of_gamut": "squash"}, "unknown-gamut-mapping"),
        ("small_cube", texture.Spectrum((500.0, 400.0)), {}, "option"),
        ("small_cube", texture.Spectrum((500.0, 500.0 + 1e-8)), {}, "option"),
        ("small_cube", texture.Spectrum((-5.0,)), {}, "invalid-wavelengths"),
    ],
)
def test_impossible_settings_raise(cube, encoding, options, code, request):
    with raises(OptionError, code):
        texture.prepare(request.getfixturevalue(cube), encoding, **options)


def test_pixels_near_unrealisable_nodes_are_counted(small_cube, spectral, colours, tmp_path):
    from uplift.lattice import Status

    data = small_cube.data
    corner = np.zeros(data.lattice.size, dtype=bool)
    corner[-1] = True  # white
    status = np.where(corner, Status.UNREALISABLE, data.points.status).astype(np.uint8)
    distance = np.where(corner, 0.1, 0).astype(np.float32)
    wide = replace(small_cube, data=with_points(data, status=status, distance=distance))
    uplifter = texture.prepare(wide, texture.Moments(), threads=1)
    source = write_exr(tmp_path / "in.exr", planes(colours))
    counts = texture.convert(uplifter, source, tmp_path / "out.exr").counts
    near = (colours > data.lattice.nodes[-2]).all(axis=-1)
    assert 0 < counts.unrealisable <= near.sum()
    assert counts.warnings()[0].code == "pixels-unrealisable"
    assert spectral.rgb_error is None
