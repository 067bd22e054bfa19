"""``uplift info``."""

from __future__ import annotations

import dataclasses

import uplift
from tests.helpers import with_points
from uplift.cube import digest, write


def test_json_has_all_fields(ask, cubes):
    path = cubes / "moments-8-macbeth.uplift"
    data = uplift.load(path).data
    facts = ask("info", path)
    assert (facts["dim"], facts["points"], facts["coefficients"]) == (8, 512, 9)
    assert facts["model"] == data.model.describe()
    assert facts["status"] == data.points.counts()
    assert sum(facts["status"].values()) == 512
    assert facts["entries"] == list(data.atlas.names)
    assert facts["worst_distance"] == float(data.points.distance.max())
    assert (facts["reference"], facts["mean_standard_error"]) == ("A", data.points.standard_error.mean(dtype=float))
    assert facts["rounds"] == data.points.round.max() + 1
    assert facts["provenance"]["left_out"] == ["cyan"]
    assert facts["digest"] == digest(data)


def test_default_is_the_packaged_cube(run, ask):
    assert ask("info")["digest"] == digest(uplift.load().data)
    assert "packaged cube" in run("info").stdout


def test_without_debug_information_there_are_no_rounds(ask, small_cube, home):
    write(with_points(small_cube.data, round=None), home / "plain.uplift")
    facts = ask("info", "plain.uplift")
    assert (facts["debug"], facts["rounds"]) == (False, None)


def test_texts_show_names_as_they_are(run, small_cube, home):
    names = ("[/red]", "[bold]tile\x1b[2J", *small_cube.data.atlas.names[2:])
    atlas = dataclasses.replace(small_cube.data.atlas, names=names)
    write(dataclasses.replace(small_cube.data, atlas=atlas), home / "a[red].uplift")
    text = " ".join(run("info", "a[red].uplift").stdout.split())
    for part in ("a[red].uplift", "[/red]; [bold]tile\\x1b[2J;", "macbeth.txt", "dim 8", "left out cyan"):
        assert part in text
    colours = "\n".join(",".join(map(str, rgb)) for rgb in small_cube.data.atlas.rgb[:2].tolist())
    lines = run("query", "--cube", "a[red].uplift", "-", input=colours).stdout.splitlines()
    assert [line.split("  ")[-1] for line in lines[1:]] == ["[/red]", "[bold]tile\\x1b[2J"]


def test_invalid_files_are_errors(refuse, home, repository):
    error = refuse("info", "none.uplift")
    assert (error.code, error.where) == ("cube-not-found", "none.uplift")
    assert refuse("info", home).code == "not-a-regular-file"
    assert refuse("info", repository / "README.md").code == "not-a-cube"
    (home / "cut.uplift").write_bytes((repository / "cubes" / "sigmoid-8.uplift").read_bytes()[:-1])
    assert refuse("info", "cut.uplift").code == "not-a-cube"
