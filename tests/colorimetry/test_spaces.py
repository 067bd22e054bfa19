"""RGB spaces by names of colour-science and OpenColorIO, and the smallest one that holds reflectances."""

from __future__ import annotations

import colour
import numpy as np
import PyOpenColorIO
import pytest

from tests.helpers import raises
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer, spaces
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.observer import COMMON_SPACES, smallest_space
from uplift.colorimetry.spaces import find_space, look_up_space
from uplift.common.errors import OptionError, UnknownNameError

NAMES = {
    "AP1": "ACEScg", "ACEScg": "ACEScg", "lin_ap1_scene": "ACEScg", "ACES - ACEScg": "ACEScg",
    "rec2020": "ITU-R BT.2020", "Rec.2020": "ITU-R BT.2020", "lin_rec2020": "ITU-R BT.2020",
    "rec709": "ITU-R BT.709", "lin_rec709": "sRGB", "sRGB - Texture": "sRGB", "srgb_texture": "sRGB",
    "lin_p3d65": "Display P3", "AP0": "ACES2065-1", "adobergb": "Adobe RGB (1998)",
}  # fmt: skip


@pytest.mark.parametrize(("name", "expected"), NAMES.items())
def test_names_of_a_space(name, expected):
    assert look_up_space(name).name == expected
    assert observer.sensor(name).space == expected


@pytest.mark.parametrize("name", NAMES)
def test_spaces_convert_as_colour_science_does(name):
    found, sensor = find_space(name), observer.sensor("sRGB")
    codes = np.array([[0.2, 0.5, 0.8], [1, 1, 1]])
    is_encoded = name in ("sRGB - Texture", "srgb_texture", "adobergb")
    linear = found.decode(codes) if is_encoded else codes
    decoded = {"adobergb": codes ** (563 / 256)}.get(name, colour.models.eotf_sRGB(codes)) if is_encoded else codes
    expected = decoded @ conversion(observer.primaries(NAMES[name]), SRGB).T
    np.testing.assert_allclose(linear @ conversion(found.gamut, SRGB).T, expected, rtol=0, atol=1e-3)
    assert found.floats_are_codes == is_encoded
    assert found.agrees_with(sensor, encoded=False) == (NAMES[name] in ("sRGB", "ITU-R BT.709") and not is_encoded)


@pytest.mark.parametrize("name", ["lin_ap9", "raw", "", "a\0b", "a\n"])
def test_unknown_names_raise(name):
    with raises(UnknownNameError, "unknown-rgb-space"):
        find_space(name)
    with raises(UnknownNameError, "unknown-rgb-space"):
        observer.sensor(name)


def test_the_configuration_of_the_environment_comes_first(tmp_path, monkeypatch):
    config = PyOpenColorIO.Config.CreateFromFile(spaces.BUILT_IN)
    path = tmp_path / "config.ocio"
    path.write_text(config.serialize().replace("Linear Rec.2020", "house"))
    with raises(UnknownNameError, "unknown-rgb-space"):
        find_space("house")
    monkeypatch.setenv("OCIO", str(path))
    assert find_space("house").name == "house"
    assert observer.sensor("house").space == "ITU-R BT.2020"
    path.with_name("bad.ocio").write_text("ocio_profile_version: 99")
    monkeypatch.setenv("OCIO", str(path.with_name("bad.ocio")))
    with raises(OptionError, "option"):
        find_space("house")


def test_smallest_space_of_the_colorchecker():
    spectra = on_grid(read_atlas("macbeth"), observer.grid())
    assert smallest_space(spectra) == "Display P3"
    assert smallest_space(spectra[:17]) == "sRGB"
    laser = np.zeros((1, 81))
    laser[0, 28] = 1
    assert smallest_space(laser) is None


def test_common_spaces_grow():
    def area(name):
        space = colour.RGB_COLOURSPACES[name]
        (a, b, c) = colour.xy_to_Luv_uv(space.primaries)
        return abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])

    areas = [area(name) for name in COMMON_SPACES]
    assert areas == sorted(areas)
