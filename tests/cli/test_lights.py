"""``uplift query --emission`` and the refusals of ``uplift build --emission``."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner
from uplift_cli.main import main


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
