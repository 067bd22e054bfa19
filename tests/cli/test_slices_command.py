"""``uplift slices`` from the outside."""

from __future__ import annotations

import OpenEXR
import pytest
from click.testing import CliRunner
from uplift_cli.slices import command

from uplift.cube import write
from uplift.errors import CubeFileError, OutputError


@pytest.fixture
def cube(hand_made, tmp_path, monkeypatch):
    """A cube file in the working folder."""
    monkeypatch.chdir(tmp_path)
    write(hand_made(), "small.uplift")
    return "small.uplift"


def run(*arguments: str, code: int = 0) -> str:
    result = CliRunner().invoke(command, arguments, catch_exceptions=False)
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
    with pytest.raises(OutputError, match=f"{exists}: exists already"):
        run(cube, "out.exr", "--sheet", "sheet.png")
    assert {path.name for path in tmp_path.iterdir()} == {cube, exists}
    run(cube, "out.exr", "--sheet", "sheet.png", "--force")


def test_the_cube_itself_is_no_output(cube):
    with pytest.raises(OutputError, match="slices are OpenEXR"):
        run(cube, cube, "--force")


def test_no_cube(tmp_path):
    (tmp_path / "text.uplift").write_text("no cube")
    for name in ("text.uplift", "missing.uplift"):
        with pytest.raises(CubeFileError):
            run(str(tmp_path / name), str(tmp_path / "out.exr"))


def test_help_has_examples():
    text = run("--help")
    assert "[OUT.exr]" in text
    assert "    uplift slices macbeth-32.uplift --sheet macbeth-32.png" in text.splitlines()
