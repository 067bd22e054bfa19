"""Measured lamps in place of the names of illuminants: sampling, names in results, and
files that are refused.
"""

import json

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import MACBETH
from tests.helpers import quiet_build, raises
from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import Lamp
from uplift.common.errors import AtlasError, OptionError, UnknownNameError
from uplift.extras.emission.lamps import find_light, read_lamp
from uplift.extras.report.rebuild import rebuild

NM = np.arange(380.0, 781.0, 5.0)
WARM = np.exp((NM - 560) / 90)
ROWS = "\n".join(f"{nm:g}\t{power:.6f}" for nm, power in zip(NM, WARM, strict=True))


@pytest.fixture
def write(tmp_path):
    def write(name, text):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def warm(write):
    return write("warm.spd", ROWS)


def test_a_lamp_with_the_power_of_an_illuminant_is_that_illuminant():
    power = colour.SDS_ILLUMINANTS["A"].copy().align(colour.SpectralShape(380, 780, 5))
    lamp = Lamp("bulb", tuple(power.wavelengths), tuple(power.values / 40))
    sensor = observer.sensor("ACEScg", lamp)
    assert sensor.illuminant == "bulb"
    expected = observer.sensor("ACEScg", "A").matrix
    assert_allclose(sensor.matrix, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("line", [500, 502, 543])
def test_narrow_lines_keep_their_energy(line):
    fine = np.arange(380.0, 781.0)
    lamp = Lamp("laser", tuple(fine), tuple((fine == line).astype(float)))
    power = lamp.at(NM)
    assert power.sum() * 5 == pytest.approx(1)
    assert power @ NM == pytest.approx(line * power.sum())
    assert_array_equal(lamp.at(fine), lamp.power)


@pytest.mark.parametrize(
    ("wavelengths", "power"),
    [
        ((400,), (1,)),
        ((400, 700), (1,)),
        ((700, 400), (1, 1)),
        ((400, 700), (0, 0)),
        ((400, 700), (-1, 1)),
        ((400, 700), (1, np.nan)),
    ],
)
def test_bad_lamps(wavelengths, power):
    with raises(OptionError, "option"):
        Lamp("bad", wavelengths, power)


FIRST = {"illuminant": "x", "range": [380, 780, 5], "spec": WARM.tolist()}
PRESENT = {
    "spectral_data": {
        "index": {"main": ["power"]},
        "data": {"main": dict(zip(map(str, NM), WARM[:, None].tolist(), strict=True))},
    }
}
"""Forms of rawtoaces."""
CAMERA = {"range": [380, 780, 5], "sensitivity": [[1, 2, 3]] * 81}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("warm.spd", ROWS),
        ("first.json", json.dumps(FIRST)),
        ("present.json", json.dumps(PRESENT)),
    ],
)
def test_formats_of_files(write, name, text):
    path = write(name, text)
    lamp = read_lamp(path)
    assert (lamp.name, find_light(str(path))) == (path.stem, lamp)
    assert_allclose(lamp.at(NM), WARM / WARM.max(), rtol=1e-4, atol=1e-6)


def test_lamps_of_one_file_have_names(write):
    path = write("two.csv", "SPD,400,550,700\nA,1,2,3\nwarm,3,-0.01,1\n")
    lamp = read_lamp(path, "warm")
    assert lamp == find_light(f"{path}:warm")
    assert lamp.name == "warm"
    assert lamp.power == (1.0, 0.0, pytest.approx(1 / 3))
    assert read_lamp(path, "A").name == "two.csv:A"


@pytest.mark.parametrize("name", ["D65.csv", "3200K.txt"])
def test_names_of_illuminants_are_not_taken(write, name):
    assert read_lamp(write(name, f"nm\tpower\n{ROWS}")).name == name
    with raises(OptionError, "option"):
        observer.light(Lamp("A", (400, 700), (1, 1)))


@pytest.mark.parametrize(
    ("name", "text", "code"),
    [
        ("words.spd", "a lamp\nof words\n", "not-an-atlas"),
        ("short.csv", "450,1\n500,2\n600,1\n", "atlas"),
        ("dark.csv", "400,0\n700,0\n", "atlas"),
        ("filter.csv", "nm;Transmittance\n400;0,1\n500;0,2\n700;0,3\n", "not-a-lamp"),
        ("macbeth.txt", MACBETH.read_text("utf-8"), "not-a-lamp"),
        ("other.json", "[]", "atlas"),
        ("broken.json", "{", "atlas"),
        ("camera.json", json.dumps(CAMERA), "atlas"),
        ("range.json", json.dumps(FIRST | {"spec": [1, 2, 3]}), "atlas"),
        ("short.json", json.dumps(FIRST | {"range": [450, 650, 2.5]}), "atlas"),
        ("dark.json", json.dumps(FIRST | {"spec": [0] * 81}), "atlas"),
    ],
)
def test_bad_files(write, name, text, code):
    with raises(AtlasError, code) as caught:
        find_light(str(write(name, text)))
    assert name in caught.value.where


def test_python_takes_a_lamp_where_it_takes_a_name(small_cube, warm):
    rgb = [0.5, 0.2, 0.1]
    error = small_cube.standard_error(rgb, uplift.read_lamp(warm))
    assert 0 < error != small_cube.standard_error(rgb, "A")
    with raises(UnknownNameError, "unknown-name") as caught:
        small_cube.standard_error(rgb, str(warm))
    assert "uplift.read_lamp" in caught.value.hint


def test_a_build_records_its_lamps(warm, tmp_path):
    lamp = read_lamp(warm)
    cube = quiet_build("macbeth", dim=3, lights=["D65", lamp])
    path = tmp_path / "lit.uplift"
    cube.save(path)
    warm.unlink()
    again = rebuild(uplift.load(path), path)
    assert_array_equal(again.data.points.coefficients, cube.data.points.coefficients)
    assert again.data.provenance["options"]["lights"][1]["name"] == "warm"
    assert str(tmp_path) not in json.dumps(cube.data.provenance)
