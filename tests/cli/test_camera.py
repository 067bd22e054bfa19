"""Cubes of cameras from the command line."""

from __future__ import annotations

import json

import pytest

NIKON = "Nikon 5100 (NPL)"
CAMERA = ("--space", "camera", "--observer")


def test_a_camera_cube_is_built_queried_shown_and_checked(run):
    run("build", "--dim", 3, "--coefficients", 5, *CAMERA, NIKON, "--quiet")
    cube = ("--cube", "camera-3.uplift")
    answer = json.loads(run("query", *cube, 0.5, 0.5, 0.5, "--mode", "refined", "--format", "json").stdout)
    assert answer["round_trip"]["rgb"] == pytest.approx([0.5, 0.5, 0.5], abs=1e-4)
    assert len(answer["xyz"]) == 3
    assert "XYZ" in run("query", *cube, 0.5, 0.5, 0.5).stdout
    shown = json.loads(run("info", "camera-3.uplift", "--format", "json").stdout)
    assert (shown["space"], shown["provenance"]["options"]["observer"]) == (NIKON, NIKON)
    run("check", "camera-3.uplift")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("400,1,0,0\n500,0,nan,0\n", "option"),
        ("400,1,0,0\n500,0,-1,0\n", "option"),
        ("500,1,0,0\n400,0,1,0\n", "option"),
        ("900,1,0,0\n999,0,1,1\n", "option"),
    ],
)
def test_bad_sensitivities_are_refused(refuse, home, text, code):
    (home / "bad.csv").write_text(text)
    assert refuse("build", "--dim", 3, *CAMERA, "bad.csv").code == code
    assert [path.name for path in home.iterdir()] == ["bad.csv"]


def test_the_file_of_sensitivities_is_not_overwritten(run, home):
    (home / "bad.csv").write_text("400,1,0,0\n")
    run("build", "--dim", 3, *CAMERA, "bad.csv", "-o", "bad.csv", "--force", code=2)
    assert (home / "bad.csv").read_text() == "400,1,0,0\n"
