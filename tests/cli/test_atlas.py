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
from click.testing import CliRunner
from uplift_cli.commands.atlas import command

from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.common.errors import AtlasError, OutputError, UnknownNameError, UpliftWarning

ATLASES = Path(__file__).parents[2] / "atlases"
MACBETH = str(ATLASES / "macbeth.txt")


def invoke(*args):
    result = CliRunner().invoke(command, [str(arg) for arg in args], catch_exceptions=False)
    assert result.exit_code == 0
    return result


def test_table_names_every_entry_and_who_is_out_of_gamut():
    result = invoke(MACBETH)
    for name in read_atlas(MACBETH).names:
        assert name in result.stdout
    assert result.stdout.endswith("24 entries, 1 out of the sRGB gamut (cyan), 0 skipped\n")
    (line,) = [line for line in result.stdout.split("\n") if line.startswith("  cyan")]
    assert line.split() == ["cyan", "380–780", "5", "-0.0334", "0.2488", "0.3855", "out"]
    assert "\x1b" not in result.stdout


def test_json_holds_the_colours_of_the_sensor():
    answer = json.loads(
        invoke(MACBETH, "--format", "json", "--illuminant", "A", "--space", "Display P3").stdout
    )
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


def test_csv_is_csv_alone():
    rows = list(csv.DictReader(io.StringIO(invoke(ATLASES / "rawtoaces.txt", "--format", "csv").stdout)))
    assert len(rows) == 190
    clipped = [row for row in rows if row["warnings"]]
    assert [row["name"] for row in clipped] == ["patch085", "patch089", "patch114", "patch125", "patch128"]
    assert clipped[0]["warnings"] == "1.4394 at 780 nm clipped to 1"
    assert {row["in_gamut"] for row in rows} == {"true", "false"}


def test_several_files_are_one_atlas():
    assert "54 entries, 2 out" in invoke(MACBETH, ATLASES / "pmc.txt").stdout


def test_the_perfect_reflector_is_in_gamut(tmp_path):
    path = tmp_path / "white.csv"
    path.write_text("name,380,780\n[bold]white,1,1\n")
    result = invoke(path)
    assert "1 entries, 0 out of the sRGB gamut, 0 skipped" in result.stdout
    assert "[bold]white" in result.stdout


def test_skipped_entries_are_named(tmp_path):
    text = Path(MACBETH).read_text(encoding="utf-8")
    path = tmp_path / "lamps.txt"
    path.write_text(text.replace("reflectance spectrum", "emission spectrum"), encoding="utf-8")
    with pytest.warns(UpliftWarning, match="skipped"):
        result = invoke(path)
    assert "0 entries, 0 out of the sRGB gamut, 24 skipped (dark skin, light skin," in result.stdout


def test_swatches_where_the_terminal_has_colours(monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[48;2;116;79;63m" in invoke(MACBETH).stdout


def test_convert_there_and_back(tmp_path):
    table, text = tmp_path / "out.csv", tmp_path / "out.txt"
    result = invoke(MACBETH, "--convert", table)
    assert (result.stdout, result.stderr) == ("", f"{table}: 24 entries written\n")
    invoke(table, "--convert", text)
    for one, other in zip(read_atlas(text).entries, read_atlas(MACBETH).entries, strict=True):
        assert one.name == other.name
        np.testing.assert_array_equal(one.values, other.values)


def test_convert_replaces_only_by_force(tmp_path):
    path = tmp_path / "out.csv"
    path.write_text("mine")
    with pytest.raises(OutputError, match=r"out\.csv: exists already"):
        invoke(MACBETH, "--convert", path)
    assert path.read_text() == "mine"
    invoke(MACBETH, "--convert", path, "--force")
    assert len(read_atlas(path)) == 24


def test_errors_are_the_library_s():
    with pytest.raises(AtlasError, match=r"none\.txt: cannot be read"):
        invoke("none.txt")
    with pytest.raises(UnknownNameError, match="unknown RGB space 'sRGBB'; did you mean 'sRGB'"):
        invoke(MACBETH, "--space", "sRGBB")


def test_help_has_examples_on_lines_of_their_own():
    assert "\n    uplift atlas atlases/macbeth.txt\n" in invoke("--help").stdout
    assert CliRunner().invoke(command, []).exit_code == 2


def test_help_names_the_library_s_default_observer():
    assert observer.DEFAULT_OBSERVER in " ".join(invoke("--help").stdout.split())


def test_importing_the_command_is_cheap():
    code = "import sys, uplift_cli.commands.atlas; print({'numpy', 'rich', 'scipy', 'colour', 'jax'} & set(sys.modules))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "set()"
