"""Sensors, lights, RGB spaces and codes by name, compared with colour-science."""

import os
from functools import partial

import colour
import numpy as np
import PyOpenColorIO
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer, tables
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.observer import smallest_space
from uplift.common.errors import OptionError, UnknownNameError, UpliftError
from uplift.extras.colour.spaces import (
    BUILT_IN,
    find_space,
    look_up_space,
    primaries_of,
)
from uplift.extras.colour.srgb import decode, encode, to_display_codes
from uplift.extras.emission.lamps import known_lamps
from uplift.lattice.lattice import axis_nodes

CONES = "Stockman & Sharpe 2 Degree Cone Fundamentals"
NAMES = {
    "AP1": "ACEScg", "ACES - ACEScg": "ACEScg", "lin_ap1_scene": "ACEScg",
    "rec2020": "ITU-R BT.2020",
    "Rec.2020": "ITU-R BT.2020", "lin_rec2020": "ITU-R BT.2020",
    "rec709": "ITU-R BT.709", "lin_rec709": "sRGB",
    "sRGB - Texture": "sRGB", "srgb_texture": "sRGB", "lin_p3d65": "Display P3",
    "AP0": "ACES2065-1",
    "adobergb": "Adobe RGB (1998)",
}  # fmt: skip
ENCODED = {
    "sRGB - Texture": colour.models.eotf_sRGB,
    "srgb_texture": colour.models.eotf_sRGB,
}
ENCODED["adobergb"] = lambda codes: codes ** (563 / 256)


def test_colours_agree_with_colour_science(sensor):
    """Up to the rounded white of the published sRGB matrix."""
    shape = colour.SpectralShape(380, 780, 5)
    cmfs = colour.MSDS_CMFS[observer.DEFAULT_OBSERVER].copy().align(shape)
    d65 = colour.SDS_ILLUMINANTS["D65"].copy().align(shape)
    for patch in colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"].values():
        samples = patch.copy().align(shape)
        xyz = colour.sd_to_XYZ(samples, cmfs, d65, method="Integration") / 100
        assert_allclose(
            sensor.rgb(samples.values), colour.XYZ_to_RGB(xyz, "sRGB"), atol=5e-4
        )
        assert_allclose(sensor.xyz(sensor.rgb(samples.values)), xyz, rtol=1e-9)
    decoding = colour.RGB_COLOURSPACES["sRGB"].cctf_decoding(np.arange(256) / 255)
    assert_allclose(
        sensor.decoding, decoding, rtol=1e-14
    )  # powers differ between instruction sets


@pytest.mark.parametrize("illuminant", ["D65", "A", "FL11"])
def test_a_perfect_reflector_is_white(illuminant):
    sensor = observer.sensor("ProPhoto RGB", illuminant)
    assert_allclose(sensor.rgb(np.ones(81)), 1, atol=1e-14)
    assert sensor.light.white[1] == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize("kind", ["observer", "camera", "illuminant"])
@pytest.mark.parametrize("limits", [tables.WAVELENGTHS, (300.0, 900.0, 5.0)])
def test_a_response_is_0_outside_its_table_and_a_light_keeps_its_last_value(
    kind, limits
):
    start, end, step = limits
    wavelengths = np.arange(start, end + step / 2, step)
    for name in tables.names(kind):
        first, *_, last = tables.look_up(kind, name).wavelengths
        samples = tables.samples(kind, name, *limits)
        is_below = wavelengths < first
        is_above = wavelengths > last
        low, *_, high = samples[~(is_below | is_above)] * (kind == "illuminant")
        assert (samples[is_below] == low).all(), name
        assert (samples[is_above] == high).all(), name
        assert samples.any(), name


@pytest.mark.parametrize("dim", [2, 3, 8, 16, 33, 128])
def test_srgb_nodes_agree_with_colour_science(dim):
    expected = colour.models.eotf_sRGB(np.linspace(0, 1, dim))
    assert_allclose(axis_nodes("srgb", dim), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("function", "argument", "code", "near"),
    [
        (observer.sensor, "sRBG", "unknown-name", "'sRGB'"),
        (observer.light, "tungten", "unknown-name", "'tungsten'"),
        (
            partial(observer.light, "D65"),
            "CIE 1931 2 Degree",
            "unknown-name",
            "'CIE 1931",
        ),
        (partial(axis_nodes, dim=4), "srgbb", "unknown-name", "'srgb'"),
        (known_lamps().without, ("A", "D66"), "unknown-name", "'D65'"),
        *(
            (find_space, name, "unknown-name", "")
            for name in ("raw", "", "a\0b", "a\n")
        ),
        (look_up_space, "Utility - Raw", "unknown-name", ""),
        (partial(observer.sensor, "sRGB", "D65"), CONES, "option", ""),
        *((observer.light, name, "option", "") for name in ("999K", "25001K", "0K")),
    ],
)
def test_unknown_names_raise_with_near_names(function, argument, code, near):
    with raises(UpliftError, code) as caught:
        function(argument)
    assert near in caught.value.hint
    assert "Raw" not in caught.value.hint


def test_cie_xyz_by_name_keeps_its_white():
    space = find_space("CIE XYZ-D65 - Scene-referred")
    white = space.matrix(SRGB) @ SRGB.rgb_to_xyz.sum(axis=1)
    assert_allclose(white, 1, rtol=0, atol=1e-3)


@pytest.mark.parametrize("limits", [(360, 1000, 5), (380, 780, 10)])
def test_other_ranges_agree_with_colour_science(limits, sensor):
    found = observer.on_range(sensor, *limits)
    steep = np.linspace(0.1, 0.9, len(found.wavelengths))
    cmfs, power = (
        tables.aligned(kind, tables.look_up(kind, name), *limits)
        for kind, name in (
            ("observer", sensor.observer),
            ("illuminant", sensor.illuminant),
        )
    )
    distribution = colour.SpectralDistribution(steep, found.wavelengths)
    expected = colour.sd_to_XYZ(distribution, cmfs, power, method="Integration") / 100
    assert_allclose(found.xyz(found.rgb(steep)), expected, rtol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_spaces_convert_as_colour_science_does(name):
    found = find_space(name)
    sensor = observer.sensor("sRGB")
    assert look_up_space(name).name == observer.sensor(name).space == NAMES[name]
    codes = np.array([[0.2, 0.5, 0.8], [1, 1, 1]])
    linear, decoded = (
        (found.decode(codes), ENCODED[name](codes))
        if name in ENCODED
        else (codes, codes)
    )
    expected = decoded @ conversion(primaries_of(look_up_space(NAMES[name])), SRGB).T
    assert_allclose(
        linear @ conversion(found.gamut, SRGB).T, expected, rtol=0, atol=1e-3
    )
    assert found.floats_are_codes == (name in ENCODED)
    agrees = NAMES[name] in ("sRGB", "ITU-R BT.709") and name not in ENCODED
    assert found.agrees_with(sensor, encoded=False) == agrees


@pytest.mark.skipif(os.name == "nt", reason="no pipes in the file system")
def test_the_configuration_of_the_environment_comes_first(tmp_path, monkeypatch):
    path = tmp_path / "config.ocio"
    config = PyOpenColorIO.Config.CreateFromFile(BUILT_IN)
    path.write_text(config.serialize().replace("Linear Rec.2020", "house"))
    with raises(UnknownNameError, "unknown-name"):
        find_space("house")
    monkeypatch.setenv("OCIO", str(path))
    assert find_space("house").name == "house"
    assert observer.sensor("house").space == "ITU-R BT.2020"
    path.with_name("bad").write_text("ocio_profile_version: 99")
    os.mkfifo(path.with_name("pipe"))
    for name, code in (("bad", "option"), ("pipe", "file-unreadable")):
        monkeypatch.setenv("OCIO", str(path.with_name(name)))
        with raises(OptionError, code):
            find_space("house")


def test_the_smallest_space_has_all_colours():
    spectra = on_grid(read_atlas("macbeth"), observer.grid())
    assert smallest_space(spectra) == "Display P3"
    assert smallest_space(spectra[:17]) == "sRGB"
    assert smallest_space(np.eye(81)[28:29]) is None


def test_transfer_curve_agrees_with_the_standard_and_is_invertible():
    linear = np.linspace(0, 1, 300)
    assert_allclose(
        encode(linear), colour.models.eotf_inverse_sRGB(linear), rtol=0, atol=1e-6
    )
    assert_allclose(decode(encode(linear)), linear, rtol=0, atol=1e-6)
    codes = np.random.default_rng(0).integers(0, 256, (500, 3))
    assert_array_equal(to_display_codes(decode(codes / 255), SRGB), codes)


@pytest.mark.parametrize(
    ("space", "illuminant"), [("ProPhoto RGB", "D50"), ("sRGB", "A")]
)
def test_other_spaces_keep_their_appearance(space, illuminant):
    """An sRGB sensor under the illuminant of the cube adapts by Bradford's transform
    too.
    """
    own, screen = (observer.sensor(name, illuminant) for name in (space, "sRGB"))
    rgb = 0.3 + 0.3 * np.random.default_rng(1).random((200, 3))  # pale enough for sRGB
    expected = 255 * encode(own.xyz(rgb) @ screen.xyz_to_rgb.T)
    assert np.abs(to_display_codes(rgb, own) - expected).max() < 0.6


@pytest.mark.parametrize(
    ("name", "standard"), [("Tungsten", "A"), ("led", "LED-B3"), ("sodium", "HP1")]
)
def test_lights_have_everyday_names(name, standard):
    assert observer.light(name).name == standard


@pytest.mark.parametrize("kelvin", [1000, 3999])
def test_black_bodies_are_those_of_colour_science(kelvin):
    """Theirs has a rounded constant."""
    theirs = colour.sd_blackbody(kelvin, colour.SpectralShape(380, 780, 5)).values
    ours = observer.illuminant_spd(f"{kelvin} k")
    assert_allclose(ours / ours[36], theirs / theirs[36], rtol=5e-4)
    named = tables.look_up("illuminant", f"{kelvin}K")
    named = named.align(colour.SpectralShape(380, 780, 5)).values
    assert_allclose(named / named[36], ours / ours[36], rtol=1e-9)


@pytest.mark.parametrize("nominal", [50, 55, 65, 75])
def test_temperatures_from_4000_k_are_cie_daylight(nominal):
    found = observer.illuminant_spd(f"{nominal}00K")
    assert_allclose(found, observer.illuminant_spd(f"D{nominal}"), rtol=0, atol=1e-3)
    assert observer.sensor("sRGB", f"{nominal}00.0 K").illuminant == f"{nominal}00K"
