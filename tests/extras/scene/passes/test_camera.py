"""Raw values of a camera from passes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.camera import Camera
from uplift.common.errors import OptionError, UnknownNameError
from uplift.extras.scene.passes.bands import PRESETS
from uplift.extras.scene.passes.camera import with_camera
from uplift.extras.scene.passes.choice import fit_bands
from uplift.extras.scene.passes.decoder import decoder
from uplift.extras.scene.passes.file import read_passes, write_passes
from uplift.extras.scene.passes.passes import scaled_power

LIGHTS = ("D65", "A", "FL11")
NIKON = "Nikon 5100 (NPL)"


@pytest.fixture(scope="module")
def passes(library):
    fitted = fit_bands(PRESETS[2], library, LIGHTS)
    return with_camera(fitted, library, LIGHTS, NIKON)


def test_raw_values_are_near_those_of_spectra(passes, library):
    """Products of two reflectances under each light, summed over wavelengths."""
    sensor = observer.sensor("camera", observer=NIKON)
    weights = sensor.matrix / scaled_power("D65")
    rng = np.random.default_rng(3)
    first, second = rng.choice(len(library.held_out), (2, 200))
    products = library.held_out[first] * library.held_out[second]
    textures = passes.reflectance_numbers(library.held_out)
    numbers = textures[first] * textures[second]
    decode = decoder(passes, space="camera").decode
    for light in passes.lights:
        expected = products * scaled_power(light.name) @ weights.T
        raw, counts = decode(numbers * light.numbers)
        assert not counts["pixels-negative"]
        off = np.abs(raw - expected) / (np.abs(expected) + 1e-3)
        assert np.median(off) < 0.02, light.name


def test_a_camera_of_matching_functions_has_xyz(library):
    cmfs = observer.matching_functions()
    camera = Camera("eye", observer.grid(), cmfs)
    fitted = fit_bands(PRESETS[3], library, LIGHTS)
    made = with_camera(fitted, library, LIGHTS, camera).camera
    white = observer.light("D65").white
    assert_allclose(made.matrix * white[:, None], fitted.to_xyz, atol=0.05)


def test_more_passes_have_smaller_errors(library):
    errors = [
        with_camera(fit_bands(PRESETS[count], library, LIGHTS), library, LIGHTS, NIKON)
        for count in (1, 2, 3)
    ]
    first, second, third = (made.camera.error for made in errors)
    assert first > second > third


def test_the_file_keeps_the_camera(passes, tmp_path):
    write_passes(passes, tmp_path / "passes.toml")
    again = read_passes(tmp_path / "passes.toml")
    assert again.camera.name == passes.camera.name
    assert_allclose(again.camera.matrix, passes.camera.matrix, rtol=1e-7)


def test_bad_input(library):
    fitted = fit_bands(PRESETS[1], library, LIGHTS)
    with raises(OptionError):
        decoder(fitted, space="camera")
    with raises(OptionError):
        with_camera(fitted, library, LIGHTS[:2], NIKON)
    with raises(UnknownNameError, "unknown-name"):
        with_camera(fitted, library, LIGHTS, "Kodak of 1888")
