"""OpenEXR slices, read by the OpenEXR package."""

import json

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_array_equal

from tests.cube.hand_made import hand_made
from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OutputError
from uplift.cube.file import digest
from uplift.extras.images.slices import write_slices


@pytest.fixture
def hand_made_slices(tmp_path):
    data = hand_made()
    path = tmp_path / "slices.exr"
    write_slices(data, path)
    return data, OpenEXR.File(str(path), separate_channels=True).parts


def test_every_channel_of_every_node(hand_made_slices):
    data, slices = hand_made_slices
    dim = data.lattice.dim
    names = ("distance", "status", "entry", "round", "standard_error")
    expected = {name: getattr(data.points, name) for name in names}
    expected["standardError"] = expected.pop("standard_error")
    for index, letter in enumerate("RGB"):
        rgb = data.points.rgb[:, index]
        expected |= {letter: rgb, f"lattice.{letter}": rgb}
        expected[f"target.{letter}"] = data.lattice.points[:, index]
        expected[f"coefficient.{index:02}"] = data.points.coefficients[:, index]
    for blue, part in enumerate(slices):
        assert part.name() == f"blue {blue:02} ({data.lattice.nodes[blue]:.4f})"
        assert set(part.channels) == {*expected, "deltaE2000"}
        for name, values in expected.items():
            rows = values.reshape(dim, dim, dim)[:, ::-1, blue].T
            found = part.channels[name].pixels
            assert found.dtype == np.float32
            assert_array_equal(found, rows.astype(np.float32), err_msg=name)


def test_delta_e_of_the_node_with_an_error(hand_made_slices):
    data, slices = hand_made_slices
    black, grey = (
        lab(data.sensor.xyz(np.full(3, value)), data.sensor.light.white)
        for value in (0.0, 0.25)
    )
    found = slices[0].channels["deltaE2000"].pixels
    assert found[3, 0] == pytest.approx(float(delta_e_2000(black, grey)), rel=1e-6)
    assert np.delete(found.ravel(), 12).max() < 1 < 40 < found[3, 0]


def test_headers_identify_the_cube(hand_made_slices):
    data, slices = hand_made_slices
    for blue, part in enumerate(slices):
        header = part.header
        assert header["uplift.cube"] == digest(data)
        assert (header["uplift.dim"], header["uplift.blueIndex"]) == (4, blue)
        assert header["uplift.blueValue"] == np.float32(data.lattice.nodes[blue])
        assert json.loads(header["uplift.model"]) == data.model.describe()
        assert (header["uplift.space"], header["uplift.illuminant"]) == ("sRGB", "D65")


@pytest.mark.parametrize("name", ["slices.png", "no/slices.exr"])
def test_invalid_paths_raise(tmp_path, name):
    with raises(OutputError, "output"):
        write_slices(hand_made(), tmp_path / name)
