"""``uplift info``."""

from __future__ import annotations

import dataclasses
import json

from uplift_cli.output.hints import hint_for

import uplift
from tests.helpers import with_points
from uplift.cube import digest, write


def test_json_has_all_fields(run, cubes):
    path = cubes / "moments-8-macbeth.uplift"
    data = uplift.load(path).data
    result = run("info", path, "--format", "json")
    facts = json.loads(result.stdout)
    assert result.stderr == ""
    assert (facts["dim"], facts["points"], facts["coefficients"]) == (8, 512, 9)
    assert facts["model"] == data.model.describe()
    assert (facts["space"], facts["illuminant"]) == ("sRGB", "D65")
    assert facts["status"] == data.points.counts()
    assert sum(facts["status"].values()) == 512
    assert facts["entries"] == list(data.atlas.names)
    assert facts["worst_distance"] == float(data.points.distance.max())
    assert (facts["reference"], facts["mean_standard_error"]) == (
        "A",
        float(data.points.standard_error.mean(dtype=float)),
    )
    assert facts["rounds"] == data.points.round.max() + 1
    assert facts["provenance"]["left_out"] == ["cyan"]
    assert facts["digest"] == digest(data)


def test_default_is_the_packaged_cube(run):
    assert json.loads(run("info", "--format", "json").stdout)["digest"] == digest(uplift.load().data)
    assert "packaged cube" in run("info").stdout


def test_without_debug_information_there_are_no_rounds(run, small_cube, home):
    write(with_points(small_cube.data, round=None), home / "plain.uplift")
    facts = json.loads(run("info", "plain.uplift", "--format", "json").stdout)
    assert (facts["debug"], facts["rounds"]) == (False, None)


def test_table_has_file_entries_and_options(run, cubes):
    path = cubes / "moments-8-macbeth.uplift"
    text = " ".join(run("info", path).stdout.split())
    for part in (
        "atlas primary 23",
        "dark skin",
        "macbeth.txt",
        "dim 8",
        "left out cyan",
        "D65; A; FL2; FL11",
    ):
        assert part in text
    assert "\x1b" not in text


def test_names_with_brackets_are_not_markup(run, small_cube, home):
    names = ("[/red]", "[bold]tile", *small_cube.data.atlas.names[2:])
    atlas = dataclasses.replace(small_cube.data.atlas, names=names)
    write(dataclasses.replace(small_cube.data, atlas=atlas), home / "a[red].uplift")
    text = run("info", "a[red].uplift").stdout
    assert "a[red].uplift" in text
    assert "[/red]; [bold]tile" in text
    first, second = small_cube.data.atlas.rgb[:2].tolist()
    (home / "colours.csv").write_text(f"{first}\n{second}\n".replace("[", "").replace("]", ""))
    text = run("query", "--cube", "a[red].uplift", "--input", "colours.csv").stdout
    assert "[/red]" in text
    assert "[bold]tile" in text


def test_invalid_files_are_errors(refuse, home, repository):
    error = refuse("info", "none.uplift")
    assert (error.code, error.where) == ("cube-not-found", "none.uplift")
    assert "uplift build" in hint_for(error)
    assert refuse("info", home).code == "not-a-regular-file"
    assert refuse("info", repository / "README.md").code == "not-a-cube"
    (home / "cut.uplift").write_bytes((repository / "cubes" / "sigmoid-8.uplift").read_bytes()[:-1])
    assert refuse("info", "cut.uplift").code == "not-a-cube"
