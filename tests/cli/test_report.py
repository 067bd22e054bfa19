"""``uplift report`` from the outside."""

from __future__ import annotations

import json
import shutil

import pytest

import uplift

SMALL = ("--light", "D65", "--light", "A", "--worst", "2")


@pytest.fixture
def cube(home, cubes, macbeth):
    """A stored cube and its atlas, in the working folder."""
    shutil.copy(macbeth, home)
    shutil.copy(cubes / "moments-8-macbeth.uplift", home / "macbeth-8.uplift")
    return "macbeth-8.uplift"


def test_a_page_beside_the_caller(run, home, cube):
    result = run("report", cube, *SMALL)
    assert result.stdout.startswith("macbeth-8.html: 0 points over the threshold, 23 entries, ΔE00 mean ")
    assert result.stdout.count("\n") == 1
    assert result.stderr == ""
    text = (home / "macbeth-8.html").read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>")
    assert "macbeth-8.uplift" in text
    assert str(home) not in text


def test_an_old_page_is_kept_unless_forced(run, refuse, home, cube):
    (home / "macbeth-8.html").write_text("old")
    assert refuse("report", cube).startswith("macbeth-8.html: exists already; use --force")
    assert (home / "macbeth-8.html").read_text() == "old"
    run("report", cube, *SMALL, "--force")
    assert (home / "macbeth-8.html").read_text(encoding="utf-8") != "old"


def test_json_goes_to_standard_output_or_to_a_file(run, home, cube):
    found = json.loads(run("report", cube, *SMALL, "--format", "json").stdout)
    assert found["cube"] == cube
    assert found["lights"] == ["D65", "A"]
    assert found["bytes"] == (home / cube).stat().st_size
    assert len(found["entries"]) == 23
    run("report", cube, *SMALL, "--format", "json", "-o", "numbers.json")
    assert json.loads((home / "numbers.json").read_text(encoding="utf-8")) == found
    assert not (home / "macbeth-8.html").exists()


def test_default_lights(run, cube):
    found = json.loads(run("report", cube, "--format", "json").stdout)
    assert found["lights"] == ["D65", "A", "FL2", "FL7", "FL11", "LED-B3"]


def test_another_atlas_judges_colours_that_the_cube_has_not_seen(run, repository, cube):
    other = repository / "atlases" / "babelcolor.txt"
    found = json.loads(run("report", cube, *SMALL, "--atlas", other, "--format", "json").stdout)
    assert (found["atlas"]["own"], found["atlas"]["files"]) == (False, ["babelcolor.txt"])
    assert found["entries"][0]["rms_lattice"] is None
    assert found["crowding"]["against"] == "stored"
    assert found["standard_error"]["calibration"]["count"] == len(found["entries"])
    told = run("report", cube, *SMALL, "--atlas", other).stdout
    assert ", under A " in told
    assert " predicted (root mean squares), " in told


def test_the_cube_s_own_atlas_may_be_named(run, macbeth, cubes, home):
    path = cubes / "moments-8-macbeth.uplift"
    found = json.loads(run("report", path, *SMALL, "--atlas", macbeth, "--format", "json").stdout)
    assert found["atlas"]["own"]


def test_a_cube_without_an_atlas(run, cubes, home):
    result = run("report", cubes / "sigmoid-8.uplift", *SMALL)
    assert result.stdout == "sigmoid-8.html: 0 points over the threshold\n"


def test_atlases_are_looked_for_as_check_does(run, refuse, home, cube):
    (home / "there").mkdir()
    shutil.move(home / "macbeth.txt", home / "there")
    message = refuse("report", cube)
    assert message.startswith(
        f"{cube}: its atlas 'macbeth.txt' is not to be found; name the folder with --atlas-dir"
    )
    run("report", cube, *SMALL, "--atlas-dir", "there")
    (home / "there" / "macbeth.txt").write_text("Entry ID: changed\n")
    assert "has changed" in refuse("report", cube, "--atlas-dir", "there", "--force")


def test_bad_input_is_refused_and_nothing_written(refuse, home, cube):
    (home / "text.uplift").write_text("no cube")
    before = {path.name for path in home.iterdir()}
    assert refuse("report", "none.uplift").startswith("none.uplift: no such file; ")
    assert refuse("report", "text.uplift").startswith("text.uplift: ")
    assert refuse("report", cube, "--light", "D66").startswith("unknown illuminant 'D66'; did you mean")
    assert refuse("report", cube, "--atlas", "none.txt").startswith("none.txt: cannot be read")
    assert "does not exist" in refuse("report", cube, "-o", "nowhere/page.html")
    assert {path.name for path in home.iterdir()} == before


def test_the_cube_itself_is_no_output(refuse, home, cube):
    before = (home / cube).read_bytes()
    assert refuse("report", cube, "-o", f"./{cube}", "--force").endswith("name another file with -o")
    assert (home / cube).read_bytes() == before


def test_wrong_usage(run, cube):
    assert "--worst" in run("report", cube, "--worst", "-1", code=2).stderr
    assert "CUBE" in run("report", code=2).stderr


def test_a_broken_write_leaves_nothing(run, home, cube, monkeypatch):
    monkeypatch.setattr(
        "pathlib.Path.write_text", lambda *_, **__: (_ for _ in ()).throw(OSError("disk full"))
    )
    result = run("report", cube, *SMALL, code=2)
    assert "cannot be written: disk full" in result.stderr
    assert not (home / "macbeth-8.html").exists()


def test_skipped_entries_of_another_atlas_are_told(run, home, cube):
    text = "name,400,500,600,700\ngrey,0.4,0.4,0.4,0.4\n"
    (home / "paints.csv").write_text(text)
    assert uplift.read_atlas(home / "paints.csv").names == ("grey",)
    found = json.loads(run("report", cube, *SMALL, "--atlas", "paints.csv", "--format", "json").stdout)
    assert [entry["name"] for entry in found["entries"]] == ["grey"]
