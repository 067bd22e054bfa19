"""Cubes of a scene on the command line."""

import json

import numpy as np
import pytest
from uplift_cli.output import progress

from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import near_black, with_absent_points
from uplift.cube.file import read, write

from .conftest import warning_lines


@pytest.fixture
def scene(home, small_cube):
    """The ColorChecker cube restricted to dark colours."""
    dark = with_absent_points(small_cube.data, near_black(small_cube.data))
    write(dark, home / "dark.uplift")
    return home / "dark.uplift"


def test_summary_counts_nodes_and_default_name_has_scene(
    run, ask, home, macbeth, monkeypatch
):
    monkeypatch.setattr(progress, "INTERVAL", 0)
    for name, value in (("a.exr", 0.1), ("b.1.exr", 0.2), ("b.2.exr", 0.9)):
        write_exr(home / name, planes(np.full((4, 4, 3), value, np.float32)))
    result = run("build --dim 8 --scene a.exr --scene b.*.exr --atlas", macbeth)
    data = read(home / "macbeth-8-scene.uplift")
    count = int(data.points.present.sum())
    assert 16 <= count < 300
    assert f"{count} of 512 nodes ({count / 512:.1%})" in result.stdout
    assert "reading images: 0 of 3" in result.stderr
    facts = ask("info macbeth-8-scene.uplift")
    assert (facts["nodes"], facts["status"]["absent"]) == (count, 512 - count)
    run("check macbeth-8-scene.uplift --atlas-dir", macbeth.parent)


def test_queries_of_other_colours_are_errors_unless_filled(run, refuse, scene):
    assert refuse("query 0 1 0 --cube", scene).code == "colour-not-in-scene"
    words = f"query - --cube {scene} --fill-missing --format json"
    result = run(words, input="0,1,0\n0.001,0.002,0.001\n")
    (warning,) = warning_lines(result)
    assert "1 of 2" in warning
    for answer in json.loads(result.stdout):
        assert answer["round_trip"]["delta_e_2000"] < 1e-3


def test_exports_of_all_colours_are_errors_unless_filled(run, refuse, scene):
    assert refuse("export --format c", scene).code == "sparse-cube"
    assert "512 nodes" in run("export --format c --fill-missing", scene).stdout
