"""OpenEXR slices, read by the OpenEXR package."""

import json
from itertools import product
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from tests.cube.hand_made import hand_made
from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OutputError
from uplift.cube.file import digest
from uplift.extras.images.slices import write_slices


def parts(path: Path) -> list[OpenEXR.Part]:
    return list(OpenEXR.File(str(path), separate_channels=True).parts)


@pytest.fixture
def hand_made_slices(tmp_path):
    data = hand_made()
    path = tmp_path / "slices.exr"
    write_slices(data, path)
    return data, parts(path)


def test_every_channel_of_every_node(hand_made_slices):
    data, slices = hand_made_slices
    dim = data.lattice.dim
    names = [
        f"blue {blue:02} ({value:.4f})" for blue, value in enumerate(data.lattice.nodes)
    ]
    assert [part.name() for part in slices] == names
    for red, green, blue in product(range(dim), repeat=3):
        point = (red * dim + green) * dim + blue
        points = {
            name: getattr(data.points, name)[point]
            for name in ("distance", "status", "entry", "round")
        }
        expected = {**points, "standardError": data.points.standard_error[point]}
        for index, letter in enumerate("RGB"):
            expected[letter] = expected[f"lattice.{letter}"] = data.points.rgb[
                point, index
            ]
            expected[f"target.{letter}"] = data.lattice.points[point, index]
            expected[f"coefficient.{index:02}"] = data.points.coefficients[point, index]
        channels = slices[blue].channels
        assert set(channels) == {*expected, "deltaE2000"}
        for name, value in expected.items():
            assert channels[name].pixels.dtype == np.float32
            assert channels[name].pixels[dim - 1 - green, red] == np.float32(value), (
                name
            )


def test_delta_e_of_the_node_with_an_error(hand_made_slices):
    data, slices = hand_made_slices
    light = data.sensor.light
    black, grey = (
        lab(data.sensor.xyz(np.full(3, value)), light.white) for value in (0.0, 0.25)
    )
    found = slices[0].channels["deltaE2000"].pixels
    assert found[3, 0] == pytest.approx(float(delta_e_2000(black, grey)), rel=1e-6)
    assert found[3, 0] > 40
    assert np.delete(found.ravel(), 12).max() < 1


def test_headers_identify_the_cube(hand_made_slices):
    data, slices = hand_made_slices
    for blue, part in enumerate(slices):
        header = part.header
        assert (
            header["uplift.cube"],
            header["uplift.dim"],
            header["uplift.blueIndex"],
        ) == (digest(data), 4, blue)
        assert header["uplift.blueValue"] == np.float32(data.lattice.nodes[blue])
        assert json.loads(header["uplift.model"]) == data.model.describe()
        assert (header["uplift.space"], header["uplift.illuminant"]) == ("sRGB", "D65")


@pytest.mark.parametrize(
    ("name", "code"), [("slices.png", "output"), ("no/slices.exr", "output")]
)
def test_invalid_paths_raise(tmp_path, name, code):
    with raises(OutputError, code):
        write_slices(hand_made(), tmp_path / name)
