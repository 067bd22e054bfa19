"""Measured lamps in place of the names of illuminants: sampling, names in results, and
files that are refused.
"""

import json

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
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
    named, own = (observer.sensor("ACEScg", each) for each in ("A", lamp))
    assert own.illuminant == "bulb"
    assert_allclose(own.matrix, named.matrix, rtol=1e-9, atol=1e-12)
    wide = observer.sensor("ACEScg", lamp, wavelengths=(360.0, 830.0, 1.0))
    assert_allclose(wide.rgb(np.full(471, 0.5)), 0.5, rtol=1e-12)
    (shown,) = observer.display_sensors([lamp, lamp], observer.DEFAULT_OBSERVER)
    assert_allclose(shown.light.white, observer.light("A").white, rtol=1e-9)


def test_power_is_interpolated_and_narrow_lines_keep_their_energy():
    coarse = Lamp("coarse", (400, 500, 600, 700), (1, 2, 4, 2))
    assert_allclose(
        coarse.at(NM), np.interp(NM, coarse.wavelengths, coarse.power), rtol=1e-12
    )
    fine = np.arange(380.0, 781.0, 1.0)
    for line in (500, 502, 543):
        lamp = Lamp("laser", tuple(fine), tuple(np.where(fine == line, 1.0, 0.0)))
        assert lamp.at(NM).sum() * 5 == pytest.approx(1)
        assert lamp.at(NM) @ NM == pytest.approx(line * lamp.at(NM).sum())
    smooth = Lamp("smooth", tuple(fine), tuple(np.interp(fine, NM, WARM)))
    assert_allclose(smooth.at(NM)[1:-1], WARM[1:-1], rtol=2e-3)
    assert lamp.at(fine).tolist() == list(lamp.power)


@pytest.mark.parametrize(
    ("wavelengths", "power"),
    [((400,), (1,)), ((400, 700), (1,)), ((700, 400), (1, 1)), ((400, 700), (0, 0)),
    ((400, 700), (-1, 1)),
     ((400, 700), (1, float("nan")))],
)  # fmt: skip
def test_bad_lamps(wavelengths, power):
    with raises(OptionError, "option"):
        Lamp("bad", wavelengths, power)


def test_formats_of_files(write, warm):
    rows = list(zip(NM.tolist(), WARM.tolist(), strict=True))
    files = [
        warm,
        write(
            "comma.csv",
            "wavelength,power\n" + "\n".join(f"{nm},{power:.6f}" for nm, power in rows),
        ),
        write(
            "semicolon.csv",
            "\ufeffnm;W\n"
            + "\n".join(f"{nm:g};{power:.6f}".replace(".", ",") for nm, power in rows),
        ),
        write(
            "first.json",
            json.dumps(
                {"illuminant": "x", "range": [380, 780, 5], "spec": WARM.tolist()}
            ),
        ),
        write(
            "present.json",
            json.dumps(
                {
                    "spectral_data": {
                        "index": {"main": ["power"]},
                        "data": {
                            "main": {f"{nm:g}": [power] for nm, power in reversed(rows)}
                        },
                    }
                }
            ),
        ),
    ]
    for path in files:
        lamp = read_lamp(path)
        assert (lamp.name, find_light(str(path))) == (path.stem, lamp)
        assert_allclose(lamp.at(NM), WARM / WARM.max(), rtol=1e-4, atol=1e-6)


def test_lamps_of_one_file_have_names(write):
    path = write("two.csv", "SPD,400,550,700\nA,1,2,3\nwarm,3,-0.01,1\n")
    assert read_lamp(path, "warm") == find_light(f"{path}:warm")
    assert (read_lamp(path, "warm").name, read_lamp(path, "A").name) == (
        "warm",
        "two.csv:A",
    )
    assert read_lamp(path, "warm").power == (1.0, 0.0, pytest.approx(1 / 3))
    with raises(AtlasError, "atlas") as caught:
        read_lamp(path)
    assert "'A', 'warm'" in caught.value.problem
    with raises(UnknownNameError, "unknown-name"):
        find_light(f"{path}:cold")


def test_names_of_illuminants_are_not_taken(write):
    for name in ("D65.csv", "3200K.txt"):
        assert read_lamp(write(name, f"nm\tpower\n{ROWS}")).name == name
    with raises(OptionError, "option"):
        observer.light(Lamp("A", (400, 700), (1, 1)))
    with raises(OptionError, "option"):
        observer.display_sensors(
            [Lamp("x", (400, 700), (1, 1)), Lamp("x", (400, 700), (1, 2))], "any"
        )


@pytest.mark.parametrize(
    ("name", "text", "code"),
    [
        ("empty.spd", "", "atlas"),
        ("words.spd", "a lamp\nof words\n", "not-an-atlas"),
        ("short.csv", "450,1\n500,2\n600,1\n", "atlas"),
        ("dark.csv", "400,0\n700,0\n", "atlas"),
        (
            "card.csv",
            "wavelength,reflectance\n400,0.1\n500,0.2\n700,0.3\n",
            "not-a-lamp",
        ),
        ("filter.csv", "nm;Transmittance\n400;0,1\n500;0,2\n700;0,3\n", "not-a-lamp"),
        ("other.json", "[]", "atlas"),
        ("broken.json", "{", "atlas"),
        (
            "camera.json",
            '{"range": [400, 700, 300], "sensitivity": [[1, 2, 3], [1, 2, 3]]}',
            "atlas",
        ),
        ("range.json", '{"range": [400, 800, 5], "spec": [1, 2, 3]}', "atlas"),
        ("short.json", '{"range": [450, 650, 200], "spec": [1, 2]}', "atlas"),
        (
            "none.json",
            '{"spectral_data": {"index": {"main": ["power"]}, "data": {"main": {}}}}',
            "atlas",
        ),
        (
            "huge.json",
            '{"range": [400, 700, 300], "spec": [1, 1%s]}' % ("0" * 400),
            "atlas",
        ),
        ("dark.json", '{"range": [400, 700, 300], "spec": [0, 0]}', "atlas"),
    ],
)
def test_bad_files(write, name, text, code):
    with raises(AtlasError, code) as caught:
        find_light(str(write(name, text)))
    assert name in caught.value.where


def test_folders_reflectances_and_names_of_no_file(tmp_path, repository):
    with raises(AtlasError, "file-unreadable"):
        find_light(str(tmp_path))
    with raises(AtlasError, "not-a-lamp"):
        find_light(str(repository / "atlases" / "macbeth.txt"))
    for name in ("none.spd", "macbeth", "none.csv:warm"):
        with raises(UnknownNameError, "unknown-name"):
            find_light(name)


def test_python_takes_a_lamp_where_it_takes_a_name(small_cube, warm, monkeypatch):
    lamp = uplift.read_lamp(warm)
    errors = [small_cube.standard_error([0.5, 0.2, 0.1], each) for each in ("A", lamp)]
    assert errors[1] > 0
    assert errors[0] != errors[1]
    monkeypatch.chdir(warm.parent)
    with raises(UnknownNameError, "unknown-name") as caught:
        small_cube.standard_error([0.5, 0.2, 0.1], "warm.spd")
    assert "uplift.read_lamp" in caught.value.hint


def test_a_build_records_its_lamps(warm, tmp_path):
    lamp = read_lamp(warm)
    cube = quiet_build("macbeth", dim=3, lights=["D65", lamp])
    path = tmp_path / "lit.uplift"
    cube.save(path)
    warm.unlink()
    again = rebuild(uplift.load(path), path)
    assert_array_equal(again.data.points.coefficients, cube.data.points.coefficients)
    recorded = again.data.provenance["options"]["lights"]
    assert (recorded[0], recorded[1]["name"]) == ("D65", "warm")
    assert str(tmp_path) not in json.dumps(cube.data.provenance)
    with raises(OptionError, "option"):
        quiet_build(dim=3, illuminant=lamp)
    with raises(OptionError, "option"):
        quiet_build(dim=3, lights=[lamp, Lamp("warm", (400, 700), (1, 1))])
