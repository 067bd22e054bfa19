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


@pytest.fixture(scope="module")
def relighter(small_cube):
    return prepare_relighter(small_cube, ("A", "FL3.1"), threads=1)


def test_layers_are_the_spectra_under_the_lights(
    relighter, small_cube, colours, tmp_path
):
    source = write_exr(
        tmp_path / "in.exr", {**planes(colours), "Z": colours[..., 0].copy()}
    )
    texture.convert(relighter, source, tmp_path / "out.exr")
    spectra = small_cube.reflectance(colours)
    for light, names in (("A", "RGB"), ("FL3.1", ["FL3_1.R", "FL3_1.G", "FL3_1.B"])):
        expected = observer.sensor("sRGB", light).rgb(spectra)
        assert_allclose(
            read_channels(tmp_path / "out.exr", names), expected, rtol=1e-3, atol=1e-4
        )
    assert_array_equal(channels(tmp_path / "out.exr")["Z"], colours[..., 0])


def test_colours_stay_in_the_space_of_the_image(small_cube, colours, tmp_path):
    """Under the light of the cube the image is unchanged; white and black are white and
    black under every light.
    """
    source = write_exr(
        tmp_path / "in.exr", planes(0.3 + 0.2 * colours), chromaticities=AP1
    )
    target = tmp_path / "out.exr"
    texture.convert(
        prepare_relighter(small_cube, ("D65", "HP1"), threads=1), source, target
    )
    assert_allclose(read_channels(target, "RGB"), 0.3 + 0.2 * colours, atol=1e-3)
    header = OpenEXR.File(str(target), header_only=True).parts[0].header
    assert_allclose(header["chromaticities"], AP1, rtol=1e-6)
    assert header["uplift.lights"] == "D65, HP1"
    grey = write_exr(
        tmp_path / "grey.exr",
        planes(np.full((2, 2, 3), 0.5, np.float32)),
        chromaticities=AP1,
    )
    texture.convert(
        prepare_relighter(small_cube, ("HP1",), threads=1), grey, target, force=True
    )
    assert_allclose(read_channels(target, "RGB"), 0.5, atol=0.02)


def test_the_tint_of_a_light_is_kept_on_request(small_cube, colours, tmp_path):
    source = write_exr(tmp_path / "in.exr", planes(colours))
    relighter = prepare_relighter(small_cube, ("A",), adapt=False, threads=1)
    texture.convert(relighter, source, tmp_path / "out.exr")
    xyz = small_cube.reflectance(colours) @ observer.light("A").xyz.T
    expected = xyz @ small_cube.data.sensor.xyz_to_rgb.T
    assert_allclose(
        read_channels(tmp_path / "out.exr", "RGB"), expected, rtol=1e-3, atol=1e-3
    )
