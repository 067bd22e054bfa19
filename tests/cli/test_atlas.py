"""``uplift atlas``."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys
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


def test_json_has_the_colours_under_the_sensor(invoke):
    answer = json.loads(invoke(MACBETH, "--format", "json", "--illuminant", "A", "--space", "Display P3").stdout)
    sensor = observer.sensor("Display P3", "A")
    expected = sensor.rgb(on_grid(read_atlas(MACBETH), sensor.wavelengths))
    np.testing.assert_allclose([entry["rgb"] for entry in answer["entries"]], expected, rtol=0, atol=1e-15)
    assert [answer[key] for key in ("space", "illuminant", "observer")] == [
        "Display P3",
        "A",
        observer.DEFAULT_OBSERVER,
    ]
    assert answer["entries"][6].keys() == {"name", "start", "end", "step", "rgb", "in_gamut", "warnings"}
    assert answer["entries"][6]["name"] == "orange"
    assert answer["sources"][0]["name"] == "macbeth.txt"
    assert answer["skipped"] == []


def test_standard_output_is_valid_csv(invoke):
    rows = list(csv.DictReader(io.StringIO(invoke(ATLASES / "rawtoaces.txt", "--format", "csv").stdout)))
    assert len(rows) == 190
    clipped = [row for row in rows if row["warnings"]]
    assert [row["name"] for row in clipped] == ["patch085", "patch089", "patch114", "patch125", "patch128"]
    assert clipped[0]["warnings"] == "1.4394 at 780 nm clipped to 1"
    assert {row["in_gamut"] for row in rows} == {"true", "false"}


def test_several_files_are_read_as_one_atlas(invoke):
    assert "54 entries, 2 out" in invoke(MACBETH, ATLASES / "pmc.txt").stdout


def test_perfect_reflector_is_in_gamut(invoke, tmp_path):
    path = tmp_path / "white.csv"
    path.write_text("name,380,780\n[bold]white,1,1\n")
    result = invoke(path)
    assert "1 entries, 0 out of the sRGB gamut, 0 skipped" in result.stdout
    assert "[bold]white" in result.stdout


def test_skipped_entries_are_listed(invoke, tmp_path):
    text = Path(MACBETH).read_text(encoding="utf-8")
    path = tmp_path / "lamps.txt"
    path.write_text(text.replace("reflectance spectrum", "emission spectrum"), encoding="utf-8")
    result = invoke(path)
    assert warning_lines(result)
    assert "0 entries, 0 out of the sRGB gamut, 24 skipped (dark skin, light skin," in result.stdout


def test_colour_terminals_show_swatches(invoke, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[48;2;116;79;63m" in invoke(MACBETH).stdout


def test_conversion_round_trip(invoke, tmp_path):
    table, text = tmp_path / "out.csv", tmp_path / "out.txt"
    result = invoke(MACBETH, "-o", table)
    assert (result.stdout, result.stderr) == ("", f"{table}: 24 entries\n")
    invoke(table, "-o", text)
    for one, other in zip(read_atlas(text).entries, read_atlas(MACBETH).entries, strict=True):
        assert one.name == other.name
        np.testing.assert_array_equal(one.values, other.values)


def test_convert_replaces_files_only_with_force(invoke, refuse, tmp_path):
    path = tmp_path / "out.csv"
    path.write_text("mine")
    error = refuse("atlas", MACBETH, "-o", path)
    assert (error.code, error.path) == ("file-exists", path)
    assert path.read_text() == "mine"
    invoke(MACBETH, "-o", path, "--force")
    assert len(read_atlas(path)) == 24


def test_invalid_input_is_an_error(refuse):
    error = refuse("atlas", "none.txt")
    assert (error.code, error.where) == ("file-not-found", "none.txt")
    assert "'macbeth'" in refuse("atlas", "macbet.txt").hint
    error = refuse("atlas", MACBETH, "--space", "sRGBB")
    assert error.code == "unknown-rgb-space"
    assert "'sRGB'" in error.hint


def test_shipped_atlases_are_listed_without_a_file(invoke, monkeypatch):
    monkeypatch.setenv("COLUMNS", "400")
    lines = invoke().stdout.splitlines()
    assert lines[0].split() == ["name", "entries", "content", "source", "licence"]
    (row,) = [line.split() for line in lines if line.startswith("macbeth ")]
    assert row[:4] == ["macbeth", "24", "24", "patches"]
    assert "BSD-3-Clause" in row


def test_list_of_shipped_atlases_in_json_and_csv(invoke):
    atlases = json.loads(invoke("--format", "json").stdout)["atlases"]
    assert [atlas["name"] for atlas in atlases] == sorted(path.stem for path in ATLASES.glob("*.txt"))
    for atlas in atlases:
        file = read_atlas(atlas["path"])
        assert atlas["entries"] == len(file)
        assert atlas["digest"] == file.sources[0].digest
        assert "colour-science" in atlas["source"]
        assert "BSD-3-Clause" in atlas["licence"]
    rows = list(csv.DictReader(io.StringIO(invoke("--format", "csv").stdout)))
    assert [(row["name"], int(row["entries"]), row["licence"]) for row in rows] == [
        (atlas["name"], atlas["entries"], atlas["licence"]) for atlas in atlases
    ]


def test_convert_needs_a_file(misuse, tmp_path):
    assert "-o" in misuse("atlas", "-o", tmp_path / "out.csv")


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


def test_help_has_one_example_per_line(invoke):
    assert "\n    uplift atlas macbeth\n" in invoke("--help").stdout


def test_help_has_the_default_observer(invoke):
    assert observer.DEFAULT_OBSERVER in " ".join(invoke("--help").stdout.split())


def test_importing_the_command_is_cheap():
    slow = "{'numpy', 'rich', 'scipy', 'colour', 'jax'}"
    code = f"import sys, uplift_cli.commands.atlas; print({slow} & set(sys.modules))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "set()"
