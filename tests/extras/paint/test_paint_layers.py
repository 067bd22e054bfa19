"""Pictures as layers of paint: shares that sum to 1, and the colours that they have."""

import json
from dataclasses import replace

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

from tests.extras.paint.invented import invented
from tests.extras.texture.conftest import channels, planes, read_channels, write_exr
from tests.helpers import raises
from uplift.colorimetry import delta_e_rgb
from uplift.common.errors import OptionError, OutputError, UnknownNameError
from uplift.extras.paint import paint_layers
from uplift.extras.texture import convert

NAMES = ("white", "yellow", "blue")


@pytest.fixture(scope="module")
def paints():
    return invented(names=NAMES)


@pytest.fixture(scope="module")
def layers(paints):
    return paint_layers(paints)


@pytest.fixture
def painted(layers):
    """Linear RGB (8, 9, 3) of known mixtures."""
    shares = np.random.default_rng(9).dirichlet(np.full(3, 0.6), (8, 9))
    rgb = layers.sensor.rgb(layers.paints.reflectance(shares))
    return np.clip(rgb, 0, 1).astype(np.float32)


def test_shares_are_positive_and_sum_to_1(layers):
    rgb = np.random.default_rng(3).random((5, 7, 3)).astype(np.float32)
    rgb[0] = rgb[0].round()
    shares = layers.shares(rgb)
    assert shares.shape == (5, 7, 3)
    assert (shares >= 0).all()
    assert_allclose(shares.sum(axis=-1), 1, atol=1e-12)


def test_the_colours_are_those_of_the_shares(layers, tmp_path, painted):
    write_exr(tmp_path / "in.exr", planes(painted))
    convert(layers, tmp_path / "in.exr", tmp_path / "out.exr")
    names = [f"{name}.Y" for name in NAMES]
    assert set(channels(tmp_path / "out.exr")) == {*"RGB", *names}
    shares = read_channels(tmp_path / "out.exr", names)
    rgb = read_channels(tmp_path / "out.exr", "RGB")
    assert_allclose(shares.sum(axis=-1), 1, atol=1e-6)
    mixed = layers.sensor.rgb(layers.paints.reflectance(shares))
    assert_allclose(rgb, np.clip(mixed, 0, 1), atol=1e-5)
    header = OpenEXR.File(str(tmp_path / "out.exr")).header()
    assert json.loads(header["uplift.paints"]) == list(NAMES)


def test_a_picture_of_mixtures_is_painted_again(layers, painted):
    (rgb, _), _ = layers.convert(painted)
    errors = delta_e_rgb(layers.sensor, rgb, painted)
    assert errors.mean() < 0.6
    assert np.quantile(errors, 0.9) < 1.5


def test_colours_out_of_reach_get_near_ones(layers):
    """Red is not a mixture of these paints; white is as near as the white paint."""
    errors = layers.delta_e.reshape(17, 17, 17)
    assert errors[16, 0, 0] > 20
    white = np.clip(layers.sensor.rgb(layers.paints.reflectance([1, 0, 0])), 0, 1)
    assert errors[-1, -1, -1] <= delta_e_rgb(layers.sensor, white, np.ones(3)) + 0.3


def test_one_paint_is_one_layer(paints):
    alone = paint_layers(paints.select(["blue"]))
    (rgb, shares), _ = alone.convert(np.zeros((2, 2, 3), np.float32))
    assert_allclose(shares, 1)
    own = alone.sensor.rgb(alone.paints.reflectance([1]))
    assert_allclose(rgb, np.broadcast_to(own, (2, 2, 3)), atol=1e-6)
    assert alone.channels == ("blue.Y",)


def test_names_of_channels_have_one_full_stop(paints):
    named = replace(paints.select(["white"]), names=("No. 7: weiß",))
    assert paint_layers(named).channels == ("No_ 7: weiß.Y",)
    twins = replace(paints, names=("a.b", "a_b", "c"))
    with raises(OptionError):
        paint_layers(twins)


def test_too_many_paints_raise(paints):
    rows = [0] * 9
    many = replace(
        paints,
        names=tuple(f"{row}" for row in range(9)),
        pigments=paints.pigments.select(rows),
    )
    with raises(OptionError, "too-many-paints"):
        paint_layers(many)


def test_invalid_options_raise(paints, layers, tmp_path, painted):
    with raises(UnknownNameError):
        paint_layers(paints, encoding="gamma")
    with raises(UnknownNameError):
        paint_layers(paints, out_of_gamut="none")
    write_exr(tmp_path / "in.exr", planes(painted))
    with raises(OutputError, "output-is-input"):
        convert(layers, tmp_path / "in.exr", tmp_path / "in.exr")
