"""Sensors, lights and tables by name, compared with colour-science."""

from __future__ import annotations

import colour
import numpy as np
import pytest

import uplift
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.common.errors import UnknownNameError

SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("illuminant", ["D65", "A", "FL11"])
def test_perfect_reflector_is_white(space, illuminant):
    sensor = observer.sensor(space, illuminant)
    np.testing.assert_allclose(sensor.rgb(np.ones(81)), 1, atol=1e-14)
    assert sensor.light.white[1] == pytest.approx(1, abs=1e-15)


def test_colours_agree_with_colour_science(sensor):
    """Up to the rounded white of the published sRGB matrix."""
    shape = colour.SpectralShape(380, 780, 5)
    cmfs = colour.MSDS_CMFS[observer.DEFAULT_OBSERVER].copy().align(shape)
    d65 = colour.SDS_ILLUMINANTS["D65"].copy().align(shape)
    for patch in colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"].values():
        samples = patch.copy().align(shape)
        xyz = colour.sd_to_XYZ(samples, cmfs, d65, method="Integration") / 100
        np.testing.assert_allclose(sensor.rgb(samples.values), colour.XYZ_to_RGB(xyz, "sRGB"), atol=5e-4)


def test_xyz_of_rgb_equals_xyz_of_reflectance(sensor):
    reflectance = np.random.default_rng(1).random((10, 81))
    np.testing.assert_allclose(sensor.xyz(sensor.rgb(reflectance)), reflectance @ sensor.light.xyz.T, atol=1e-14)


def test_decoding_agrees_with_colour_science(sensor):
    expected = colour.RGB_COLOURSPACES["sRGB"].cctf_decoding(np.arange(256) / 255)
    np.testing.assert_array_equal(sensor.decoding, expected)


@pytest.mark.parametrize("dim", [2, 3, 8, 16, 33, 128])
def test_srgb_nodes_agree_with_colour_science(dim):
    expected = colour.models.eotf_sRGB(np.linspace(0, 1, dim))
    np.testing.assert_allclose(observer.axis_nodes("srgb", dim), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", ["moments-8", "moments-16"])
def test_stored_nodes_are_reproduced_exactly(name, repository):
    nodes = uplift.load(repository / "cubes" / f"{name}.uplift").data.lattice.nodes
    np.testing.assert_array_equal(observer.axis_nodes("srgb", len(nodes)), nodes)


@pytest.mark.parametrize(
    ("call", "code", "near"),
    [
        (lambda: observer.sensor("sRBG"), "unknown-rgb-space", "'sRGB'"),
        (lambda: observer.light("D66"), "unknown-illuminant", "'D65'"),
        (
            lambda: observer.light("D65", "CIE 1931 2 Degree"),
            "unknown-observer",
            "'CIE 1931 2 Degree Standard Observer'",
        ),
        (lambda: observer.axis_nodes("srgbb", 4), "unknown-axis-spacing", "'srgb'"),
    ],
)
def test_unknown_names_raise_with_near_names(call, code, near):
    with raises(UnknownNameError, code) as caught:
        call()
    assert near in caught.value.hint


@pytest.mark.parametrize("limits", [(360, 830, 1), (360, 1000, 5), (380, 780, 10)])
def test_other_ranges_agree_with_colour_science(limits, sensor):
    found = observer.on_range(sensor, *limits)
    assert found.range == limits
    np.testing.assert_allclose(found.rgb(np.ones(len(found.wavelengths))), 1, rtol=0, atol=1e-14)
    shape = colour.SpectralShape(*limits)
    steep = colour.SpectralDistribution(np.linspace(0.1, 0.9, len(found.wavelengths)), found.wavelengths)
    cmfs, light = (
        colour.MSDS_CMFS[sensor.observer].copy().align(shape),
        colour.SDS_ILLUMINANTS["D65"].copy().align(shape),
    )
    expected = colour.sd_to_XYZ(steep, cmfs, light, method="Integration") / 100
    np.testing.assert_allclose(found.xyz(found.rgb(steep.values)), expected, rtol=1e-9)
    displays = observer.display_sensors(["D65", "A"], sensor.observer, *limits)
    assert [each.range for each in displays] == [limits] * 2
    np.testing.assert_array_equal(observer.light("D65", sensor.observer, *limits).xyz, found.light.xyz)
