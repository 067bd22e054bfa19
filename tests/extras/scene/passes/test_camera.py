"""Raw values of a camera from passes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.scene.passes.conftest import LIGHTS
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.common.errors import OptionError, UnknownNameError
from uplift.extras.scene.passes.camera import with_camera
from uplift.extras.scene.passes.decoder import decoder
from uplift.extras.scene.passes.file import read_passes, write_passes
from uplift.extras.scene.passes.passes import scaled_power

NIKON = "Nikon 5100 (NPL)"


@pytest.fixture(scope="module")
def passes(library, two_passes):
    return with_camera(two_passes, library, LIGHTS, NIKON)


def test_raw_values_are_near_those_of_spectra(passes, library):
    """Products of two reflectances under each light, summed over wavelengths."""
    sensor = observer.sensor("camera", observer=NIKON)
    weights = sensor.matrix / scaled_power("D65")
    drawn = np.random.default_rng(3).permutation(library.held_out)
    first, second = drawn[:100], drawn[100:200]
    decode = decoder(passes, space="camera").decode
    numbers = passes.reflectance_numbers(first) * passes.reflectance_numbers(second)
    for light in passes.lights:
        expected = first * second * scaled_power(light.name) @ weights.T
        raw, counts = decode(numbers * light.numbers)
        assert not counts["pixels-negative"]
        off = np.abs(raw - expected) / (np.abs(expected) + 1e-3)
        assert np.median(off) < 0.02, light.name


def test_the_file_keeps_the_camera(passes, tmp_path):
    write_passes(passes, tmp_path / "passes.toml")
    again = read_passes(tmp_path / "passes.toml")
    assert again.camera.name == passes.camera.name
    assert_allclose(again.camera.matrix, passes.camera.matrix, rtol=1e-7)


def test_bad_input(library, two_passes):
    with raises(OptionError):
        decoder(two_passes, space="camera")
    with raises(OptionError):
        with_camera(two_passes, library, LIGHTS[:2], NIKON)
    with raises(UnknownNameError, "unknown-name"):
        with_camera(two_passes, library, LIGHTS, "Kodak of 1888")
