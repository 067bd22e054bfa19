"""Images of full size under other lights."""

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.extras.texture.conftest import channels, planes, read_channels, write_exr
from uplift.colorimetry import observer
from uplift.extras import texture
from uplift.extras.relight.relighter import prepare_relighter

AP1 = (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767)


@pytest.fixture
def relit(small_cube, tmp_path):
    """Function that relights planes, and returns the path of the texture."""

    def relit(content, lights, adapt=True, **header):
        relighter = prepare_relighter(small_cube, lights, adapt=adapt, threads=1)
        source = write_exr(tmp_path / "in.exr", content, **header)
        target = tmp_path / "out.exr"
        return texture.convert(relighter, source, target, force=True).target

    return relit


def test_layers_are_the_spectra_under_the_lights(relit, small_cube, colours):
    depth = colours[..., 0].copy()
    path = relit({**planes(colours), "Z": depth}, ("A", "FL3.1"))
    spectra = small_cube.reflectance(colours)
    for light, names in (("A", "RGB"), ("FL3.1", ["FL3_1.R", "FL3_1.G", "FL3_1.B"])):
        expected = observer.sensor("sRGB", light).rgb(spectra)
        assert_allclose(read_channels(path, names), expected, rtol=1e-3, atol=1e-4)
    assert_array_equal(channels(path)["Z"], depth)


def test_colours_stay_in_the_space_of_the_image(relit, colours):
    """Under the light of the cube the image is unchanged; grey is grey under every
    light.
    """
    rgb = 0.3 + 0.2 * colours
    path = relit(planes(rgb), ("D65", "HP1"), chromaticities=AP1)
    assert_allclose(read_channels(path, "RGB"), rgb, atol=1e-3)
    header = OpenEXR.File(str(path), header_only=True).parts[0].header
    assert_allclose(header["chromaticities"], AP1, rtol=1e-6)
    assert header["uplift.lights"] == "D65, HP1"
    grey = planes(np.full((2, 2, 3), 0.5, np.float32))
    path = relit(grey, ("HP1",), chromaticities=AP1)
    assert_allclose(read_channels(path, "RGB"), 0.5, atol=0.02)


def test_the_tint_of_a_light_is_kept_on_request(relit, small_cube, colours):
    path = relit(planes(colours), ("A",), adapt=False)
    xyz = small_cube.reflectance(colours) @ observer.light("A").xyz.T
    expected = xyz @ small_cube.data.sensor.xyz_to_rgb.T
    assert_allclose(read_channels(path, "RGB"), expected, rtol=1e-3, atol=1e-3)
