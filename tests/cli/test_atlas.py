"""``uplift atlas``."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer

from .conftest import warning_lines

ATLASES = Path(__file__).parents[2] / "atlases"
MACBETH = str(ATLASES / "macbeth.txt")


@pytest.fixture
def invoke(run):
    """Run ``uplift atlas``."""
    return lambda *args: run("atlas", *args)


def test_table_lists_entries_and_counts_those_out_of_gamut(invoke):
    result = invoke(MACBETH)
    for name in read_atlas(MACBETH).names:
        assert name in result.stdout
    assert result.stdout.endswith("24 entries, 1 out of the sRGB gamut (cyan), 0 skipped; Display P3 holds all 24\n")
    (line,) = [line for line in result.stdout.split("\n") if line.startswith("cyan")]
    assert line.split() == ["cyan", "380:780:5", "-0.0334", "0.2488", "0.3855"]
    assert "\x1b" not in result.stdout
    assert "54 entries, 2 out" in invoke(MACBETH, ATLASES / "pmc.txt").stdout


def test_json_has_the_colours_under_the_sensor(invoke):
    answer = json.loads(invoke(MACBETH, "--format", "json", "--illuminant", "A", "--space", "Display P3").stdout)
    sensor = observer.sensor("Display P3", "A")
    expected = sensor.rgb(on_grid(read_atlas(MACBETH), sensor.wavelengths))
    np.testing.assert_allclose([entry["rgb"] for entry in answer["entries"]], expected, rtol=0, atol=1e-15)
    assert [answer[key] for key in ("space", "illuminant", "observer")] == ["Display P3", "A", sensor.observer]
    assert answer["entries"][6].keys() == {"name", "start", "end", "step", "rgb", "in_gamut", "warnings"}
    assert (answer["sources"][0]["name"], answer["skipped"]) == ("macbeth.txt", [])


def test_csv_has_the_clipped_values(invoke):
    rows = list(csv.DictReader(io.StringIO(invoke(ATLASES / "rawtoaces.txt", "--format", "csv").stdout)))
    assert len(rows) == 190
    clipped = [row for row in rows if row["warnings"]]
    assert [row["name"] for row in clipped] == ["patch085", "patch089", "patch114", "patch125", "patch128"]
    assert clipped[0]["warnings"] == "1.4394 at 780 nm clipped to 1"
    assert {row["in_gamut"] for row in rows} == {"true", "false"}


def test_perfect_reflector_is_in_gamut(invoke, home):
    (home / "white.csv").write_text("name,380,780\n[bold]white,1,1\n")
    result = invoke("white.csv")
    assert "1 entries, 0 out of the sRGB gamut, 0 skipped" in result.stdout
    assert "[bold]white" in result.stdout


def test_skipped_entries_are_listed(invoke, home):
    text = Path(MACBETH).read_text(encoding="utf-8")
    (home / "lamps.txt").write_text(text.replace("reflectance spectrum", "emission spectrum"), encoding="utf-8")
    result = invoke("lamps.txt")
    assert warning_lines(result)
    assert "0 entries, 0 out of the sRGB gamut, 24 skipped (dark skin, light skin," in result.stdout


def test_colour_terminals_show_swatches(invoke, monkeypatch):
    for name, value in {"FORCE_COLOR": "1", "COLORTERM": "truecolor", "TERM": "xterm-256color"}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[48;2;116;79;63m" in invoke(MACBETH).stdout


def test_conversion_round_trip(invoke, refuse, home):
    result = invoke(MACBETH, "-o", "out.csv")
    assert (result.stdout, result.stderr) == ("", "out.csv: 24 entries\n")
    invoke("out.csv", "-o", "out.txt")
    for one, other in zip(read_atlas("out.txt").entries, read_atlas(MACBETH).entries, strict=True):
        assert one.name == other.name
        np.testing.assert_array_equal(one.values, other.values)
    (home / "out.csv").write_text("mine")
    assert refuse("atlas", MACBETH, "-o", "out.csv").code == "file-exists"
    assert (home / "out.csv").read_text() == "mine"
    invoke(MACBETH, "-o", "out.csv", "--force")
    assert len(read_atlas("out.csv")) == 24


def test_invalid_input_is_an_error(refuse, misuse):
    error = refuse("atlas", "none.txt")
    assert (error.code, error.where) == ("file-not-found", "none.txt")
    assert "'macbeth'" in refuse("atlas", "macbet.txt").hint
    assert refuse("atlas", MACBETH, "--space", "sRGBB").code == "unknown-rgb-space"
    assert "-o" in misuse("atlas", "-o", "out.csv")


def test_shipped_atlases_are_listed_without_a_file(invoke, monkeypatch):
    monkeypatch.setenv("COLUMNS", "400")
    atlases = json.loads(invoke("--format", "json").stdout)["atlases"]
    assert [atlas["name"] for atlas in atlases] == sorted(path.stem for path in ATLASES.glob("*.txt"))
    rows = list(csv.DictReader(io.StringIO(invoke("--format", "csv").stdout)))
    table = invoke().stdout
    for atlas, row in zip(atlases, rows, strict=True):
        file = read_atlas(atlas["path"])
        assert (atlas["entries"], atlas["digest"]) == (len(file), file.sources[0].digest)
        assert "colour-science" in atlas["source"]
        assert "BSD-3-Clause" in atlas["licence"]
        assert all(text == str(atlas[key]) and text in table for key, text in row.items())


def test_names_of_shipped_atlases_work_in_an_empty_folder(invoke, home):
    expected = invoke(MACBETH).stdout
    result = invoke("macbeth")
    assert (result.stdout, result.stderr) == (expected, "")
    result = invoke("macbeth.txt")
    assert result.stdout == expected
    (warning,) = warning_lines(result)
    assert warning.startswith("macbeth.txt: ")


def test_a_file_takes_precedence_over_the_shipped_atlas(invoke, home):
    (home / "macbeth.txt").write_text("name,380,780\nwhite,1,1\n")
    result = invoke("macbeth.txt")
    assert "1 entries" in result.stdout
    assert result.stderr == ""
