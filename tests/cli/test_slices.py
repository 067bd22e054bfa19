"""``uplift slices`` from the outside."""

from __future__ import annotations

import OpenEXR
import pytest
from click.testing import CliRunner
from uplift_cli.main import main

from tests.cube.hand_made import hand_made
from uplift.cube import write


@pytest.fixture
def cube(tmp_path, monkeypatch):
    """A cube file in the working folder."""
    monkeypatch.chdir(tmp_path)
    write(hand_made(), "small.uplift")
    return "small.uplift"


def run(*arguments: str, code: int = 0) -> str:
    result = CliRunner().invoke(main, ["slices", *arguments])
    assert result.exit_code == code, result.output
    return result.output


def test_slices_and_sheet(cube, tmp_path):
    assert run(cube, "out.exr", "--sheet", "sheet.png").splitlines() == [
        "out.exr: 4 blue slices",
        "sheet.png: contact sheet",
    ]
    assert len(OpenEXR.File("out.exr").parts) == 4
    assert (tmp_path / "sheet.png").read_bytes().startswith(b"\x89PNG")


def test_the_sheet_alone(cube, tmp_path):
    assert run(cube, "--sheet", "sheet.exr") == "sheet.exr: contact sheet\n"
    assert {path.name for path in tmp_path.iterdir()} == {cube, "sheet.exr"}


def test_something_to_write_is_needed(cube):
    assert "Nothing to write" in run(cube, code=2)


def test_one_file_cannot_be_both(cube):
    assert "same file" in run(cube, "a.exr", "--sheet", "./a.exr", code=2)


@pytest.mark.parametrize("exists", ["out.exr", "sheet.png"])
def test_nothing_is_written_where_one_file_exists(cube, tmp_path, exists):
    (tmp_path / exists).write_text("old")
    output = run(cube, "out.exr", "--sheet", "sheet.png", code=2)
    assert output.startswith(f"error: {exists}: exists already; use --force")
    assert output.count("\n") == 1
    assert {path.name for path in tmp_path.iterdir()} == {cube, exists}
    run(cube, "out.exr", "--sheet", "sheet.png", "--force")


def test_the_cube_itself_is_no_output(cube):
    assert "slices are OpenEXR" in run(cube, cube, "--force", code=2)


def test_no_cube(tmp_path):
    (tmp_path / "text.uplift").write_text("no cube")
    for name in ("text.uplift", "missing.uplift"):
        assert run(str(tmp_path / name), str(tmp_path / "out.exr"), code=2).startswith("error: ")
    assert not (tmp_path / "out.exr").exists()


def test_help_has_examples():
    text = run("--help")
    assert "[OUT.exr]" in text
    assert "    uplift slices macbeth-32.uplift --sheet macbeth-32.png" in text.splitlines()
