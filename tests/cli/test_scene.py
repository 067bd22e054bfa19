"""Cubes of a scene on the command line: built, told of, asked, refused, filled."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.io.texture.conftest import channels, planes, write_exr
from tests.sparse_cubes import near_black, with_absent_points
from uplift.cube import read, write


@pytest.fixture
def scene(home, small_cube):
    """The ColorChecker cube with dark colours alone."""
    write(with_absent_points(small_cube.data, near_black(small_cube.data)), home / "dark.uplift")
    return home / "dark.uplift"


def test_build_tells_what_is_kept_and_names_the_cube_for_it(run, home, macbeth):
    for name, value in (("a.exr", 0.1), ("b.1.exr", 0.2), ("b.2.exr", 0.9)):
        write_exr(home / name, planes(np.full((4, 4, 3), value, np.float32)))
    result = run("build", "--atlas", macbeth, "--dim", 8, "--scene", "a.exr", "--scene", "b.*.exr", "-v")
    data = read(home / "macbeth-8-scene.uplift")
    count = int(data.points.present.sum())
    assert 16 <= count < 300
    assert f"macbeth-8-scene.uplift: {count} of 512 points ({count / 512:.1%})" in result.stdout
    assert "scene: read 0 of 3 images" in result.stderr
    names = [image["name"] for image in data.provenance["scene"]]
    assert names == ["a.exr", "b.1.exr", "b.2.exr"]
    facts = json.loads(run("info", "macbeth-8-scene.uplift", "--format", "json").stdout)
    assert (facts["points"], facts["lattice_points"], facts["status"]["absent"]) == (count, 512, 512 - count)
    run("check", "macbeth-8-scene.uplift", "--atlas-dir", macbeth.parent)


def test_build_refuses_bad_scenes(run, refuse, home):
    assert "no file is named like 'b.*.exr'" in refuse("build", "--scene", "b.*.exr")
    assert "c.png: there is no such file" in refuse("build", "--dim", 4, "--scene", "c.png")
    assert "--encoding is of --scene images" in run("build", "--encoding", "linear", code=2).stderr
    assert "--out-of-gamut is of --scene images" in run("build", "--out-of-gamut", "scale", code=2).stderr
    assert not list(home.glob("*.uplift"))


def test_query_refuses_other_colours_or_fills_them(run, refuse, scene):
    assert "linear RGB (0, 1, 0) is none of them" in refuse("query", "--cube", scene, 0, 1, 0)
    result = run(
        "query",
        "-",
        "--cube",
        scene,
        "--fill-missing",
        "--format",
        "json",
        input="0,1,0\n0.001,0.002,0.001\n",
    )
    assert "warning: 1 of 2 colours are none of the cube's scene" in result.stderr
    assert all(answer["round_trip"]["delta_e_2000"] < 1e-3 for answer in json.loads(result.stdout))
    assert run("query", "--cube", scene, "--fill-missing", 0.001, 0.002, 0.001).stderr == ""


def test_textures_refuse_other_colours_or_fill_them(run, refuse, scene, home, small_cube):
    rgb = np.array([[[0.001, 0.002, 0.001], [0.1, 0.9, 0.2]]], np.float32)
    write_exr(home / "image.exr", planes(rgb))
    asked = ("texture", "image.exr", "out.exr", "--cube", scene, "--store", "multipliers")
    message = refuse(*asked)
    assert "image.exr: the cube was built for the colours of a scene" in message
    assert "(0.1, 0.9, 0.2)" in message
    assert not (home / "out.exr").exists()
    run(*asked, "--fill-missing")
    found = channels(home / "out.exr")
    made = np.stack([found[f"multiplier.{index:02}"].ravel() for index in range(9)], axis=-1).astype(float)
    data = small_cube.data
    back = data.sensor.rgb(data.model.squash(made @ data.model.basis(data.sensor.wavelengths).T))
    np.testing.assert_allclose(back, rgb[0], atol=1e-5)


def test_a_report_judges_what_is_there(run, scene, macbeth):
    run("report", scene, "--atlas-dir", macbeth.parent, "-o", "page.html")
    found = json.loads(run("report", scene, "--atlas-dir", macbeth.parent, "--format", "json").stdout)
    assert found["failures"]["over_threshold"] == 0
    assert found["round_trip"]["delta_e_2000"]["spectra"]["max"] < 1e-3
    assert len(found["atlas"]["absent"]) + len(found["entries"]) == 23
    assert found["atlas"]["absent"]
    other = json.loads(run("report", scene, "--atlas", macbeth.parent / "tcs.txt", "--format", "json").stdout)
    assert other["atlas"]["absent"]


def test_an_export_that_needs_all_colours_is_filled(run, refuse, scene, home):
    assert "a header has all colours" in refuse("export", scene, "--format", "c")
    assert "512 points" in run("export", scene, "--format", "c", "--fill-missing").stdout
