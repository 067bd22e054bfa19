"""Emission tables on the command line: builds, queries, and commands that need a cube."""

from __future__ import annotations

import json

import numpy as np
import pytest
from click.testing import CliRunner
from uplift_cli.main import main
from uplift_cli.output.hints import hint_for

import uplift


def run(*words, code=0):
    result = CliRunner().invoke(main, words)
    assert result.exit_code == code, result.output
    return result


def test_a_light_has_its_colour_and_power_of_any_size():
    found = json.loads(run("query", "--emission", "30", "22", "9", "--format", "json").stdout)
    assert found["round_trip"]["rgb"] == pytest.approx([30, 22, 9], rel=1e-5)
    assert min(found["power"]) >= 0
    assert max(found["power"]) > 10
    assert 0 < found["expected_error"] < 10


def test_xyz_and_wavelengths():
    words = ("--emission", "--xyz", "0.9505", "1", "1.089", "--wavelengths", "400:700:100")
    found = run("query", *words, "--format", "csv").stdout.splitlines()
    assert found[0].split(",")[-4:] == ["400", "500", "600", "700"]


def test_colours_that_no_light_has():
    assert "--out-of-gamut clip" in run("query", "--emission", "-1", "1", "-1", code=2).stderr
    assert "round trip" in run("query", "--emission", "-1", "1", "-1", "--out-of-gamut", "clip").stdout


@pytest.mark.parametrize("words", [("query", "1", "1", "1", "--mode", "moments"), ("build", "--dim", "8")])
def test_options_that_lights_do_not_have(words):
    assert words[-2] in run(*words, "--emission", code=2).stderr


def test_a_table_of_measured_lamps_is_built_and_queried(home):
    at = np.arange(400, 701, 10)
    power = np.exp(-(((at - 600) / 40) ** 2)) + 0.1
    values = ",".join(f"{value:.6g}" for value in power)
    (home / "lamps.csv").write_text(f"# spectral irradiance\nname,{','.join(map(str, at))}\nbulb,{values}\n")
    assert "lamps" in run("build", "--emission", "--atlas", "lamps.csv", "-o", "x.uplift").stdout
    table = uplift.load_emission("x.uplift")
    assert table.lamp_names[0] == "bulb"
    assert table.data.provenance["atlases"][0]["name"] == "lamps.csv"
    rgb = table.rgb(table.data.entries.spectra[0])
    words = ("--cube", "x.uplift", "--emission", "--format", "json", "--wavelengths", "400:700:10", "--")
    found = json.loads(run("query", *words, *map(str, 5 * rgb / rgb.max())).stdout)
    assert np.array(found["power"]) / max(found["power"]) == pytest.approx(power / power.max(), abs=1e-4)
    assert json.loads(run("info", "x.uplift", "--format", "json").stdout)["lamps"][0] == "bulb"


def test_the_default_name_is_that_of_the_lamps(home):
    (home / "mine-emission.uplift").write_text("mine")
    (home / "mine.csv").write_text("# spectral irradiance\nname,400,500,600,700\nbulb,1,2,3,4\n")
    assert "mine-emission.uplift" in run("build", "--emission", "--atlas", "mine.csv", code=2).stderr
    assert (home / "mine-emission.uplift").read_text() == "mine"


@pytest.mark.parametrize(
    "words",
    [
        ("query", "1", "1", "1", "--cube", "lights.uplift"),
        ("texture", "in.png", "-o", "out.exr", "--cube", "lights.uplift"),
        ("relight", "in.png", "--cube", "lights.uplift"),
        ("mix", "#ff0000", "#0000ff", "--cube", "lights.uplift"),
        ("study", "sensitivity", "lights.uplift"),
    ],
)
def test_commands_that_need_a_cube_name_the_option(refuse, home, words):
    uplift.load_emission().save(home / "lights.uplift")
    plain_image(home / "in.png")
    error = refuse(*words)
    assert error.code == "not-a-cube"
    assert "--emission" in hint_for(error)


def test_check_names_the_option(home):
    uplift.load_emission().save(home / "lights.uplift")
    found = json.loads(run("check", "lights.uplift", "--format", "json", code=1).stdout)
    assert found[0]["failures"] == ["not-a-cube"]
    assert "--emission" in found[0]["error"]["hint"]
    assert "--emission" in run("check", "lights.uplift", code=1).stderr


def test_cubes_are_not_lights(refuse, home):
    uplift.load().save(home / "cube.uplift")
    assert refuse("query", "1", "1", "1", "--cube", "cube.uplift", "--emission").code == "not-an-emission-table"


def test_reports_of_tables(home):
    uplift.load_emission().save(home / "lights.uplift")
    assert "79 lamps" in run("report", "lights.uplift").stdout
    assert "Chromaticity diagrams" in (home / "lights.html").read_text(encoding="utf-8")
    found = json.loads(run("report", "emission", "--format", "json").stdout)
    assert found["smallest_power"] >= 0
    assert "--light" in run("report", "emission", "--light", "A", "-o", "other.html", code=2).stderr
    assert not (home / "other.html").exists()


def plain_image(path):
    from matplotlib.image import imsave

    imsave(path, np.full((2, 2, 3), 128, dtype=np.uint8))
