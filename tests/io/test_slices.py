"""OpenEXR slices, read by the OpenEXR package."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from tests.cube.hand_made import hand_made
from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OutputError
from uplift.cube import digest, write
from uplift.io.exr import write_slices


def parts(path: Path) -> list[OpenEXR.Part]:
    return list(OpenEXR.File(str(path), separate_channels=True).parts)


@pytest.fixture
def hand_made_slices(tmp_path):
    data, path = hand_made(), tmp_path / "slices.exr"
    write_slices(data, path)
    return data, parts(path)


def test_every_channel_of_every_node(hand_made_slices):
    data, slices = hand_made_slices
    dim = data.lattice.dim
    names = [f"blue {blue:02} ({value:.4f})" for blue, value in enumerate(data.lattice.nodes)]
    assert [part.name() for part in slices] == names
    for red, green, blue in product(range(dim), repeat=3):
        point = (red * dim + green) * dim + blue
        expected = {
            **{
                f"{layer}{letter}": data.points.rgb[point, i]
                for i, letter in enumerate("RGB")
                for layer in ("", "lattice.")
            },
            **{f"target.{letter}": data.lattice.points[point, i] for i, letter in enumerate("RGB")},
            **{f"coefficient.{i:02}": data.points.coefficients[point, i] for i in range(3)},
            **{name: getattr(data.points, name)[point] for name in ("distance", "status", "entry", "round")},
            "standardError": data.points.standard_error[point],
        }
        channels = slices[blue].channels
        assert set(channels) == {*expected, "deltaE2000"}
        for name, value in expected.items():
            assert channels[name].pixels.dtype == np.float32
            assert channels[name].pixels[dim - 1 - green, red] == np.float32(value), name


def test_delta_e_of_the_node_with_an_error(hand_made_slices):
    data, slices = hand_made_slices
    light = data.sensor.light
    black, grey = (lab(data.sensor.xyz(np.full(3, value)), light.white) for value in (0.0, 0.25))
    found = slices[0].channels["deltaE2000"].pixels
    assert found[3, 0] == pytest.approx(float(delta_e_2000(black, grey)), rel=1e-6)
    assert found[3, 0] > 40
    assert np.delete(found.ravel(), 12).max() < 1


def test_headers_identify_the_cube(hand_made_slices):
    data, slices = hand_made_slices
    for blue, part in enumerate(slices):
        header = part.header
        assert header["uplift.cube"] == digest(data)
        assert header["uplift.dim"] == 4
        assert header["uplift.blueIndex"] == blue
        assert header["uplift.blueValue"] == np.float32(data.lattice.nodes[blue])
        assert json.loads(header["uplift.model"]) == data.model.describe()
        assert (header["uplift.space"], header["uplift.illuminant"]) == ("sRGB", "D65")
        assert header["uplift.threshold"] == np.float32(1e-4)


def test_nan_raises(tmp_path):
    with raises(OutputError):
        write_slices(hand_made(coefficients=np.full((64, 3), np.nan)), tmp_path / "nan.exr")
    assert not list(tmp_path.iterdir())


def test_output_is_reproducible_and_replaced_only_with_force(tmp_path):
    path = tmp_path / "a.exr"
    write_slices(hand_made(), path)
    first = path.read_bytes()
    time.sleep(1.1)  # a time stamp would differ
    with raises(OutputError, "file-exists"):
        write_slices(hand_made(), path)
    write_slices(hand_made(), path, force=True)
    assert path.read_bytes() == first


@pytest.mark.parametrize(("name", "code"), [("slices.png", "unknown-suffix"), ("no/slices.exr", "output")])
def test_invalid_paths_raise(tmp_path, name, code):
    with raises(OutputError, code):
        write_slices(hand_made(), tmp_path / name)


def test_writing_images_does_not_import_the_fit(tmp_path):
    write(hand_made(), tmp_path / "small.uplift")
    script = (
        "import sys; from uplift.cube import read; from uplift.io.exr import write_slices; "
        "from uplift.viz.sheet import write_sheet\n"
        "early = {'OpenEXR', 'matplotlib'} & set(sys.modules)\n"
        "data = read('small.uplift'); write_slices(data, 'a.exr'); write_sheet(data, 'a.png')\n"
        "print(early, {'jax', 'colour', 'uplift.fit'} & set(sys.modules))"
    )
    found = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert found.stdout == "set() set()\n", found.stderr
