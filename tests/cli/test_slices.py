"""``uplift slices``."""

from __future__ import annotations

import OpenEXR
import pytest

from tests.cube.hand_made import hand_made
from uplift.cube import write


@pytest.fixture
def cube(home):
    """A cube file in the working folder."""
    write(hand_made(), "small.uplift")
    return "small.uplift"


def test_slices_and_sheet(run, cube, home):
    assert run("slices", cube, "-o", "out.exr", "--plot", "sheet.png").stdout.splitlines() == [
        "out.exr: 4 blue slices",
        "sheet.png: contact sheet",
    ]
    assert len(OpenEXR.File("out.exr").parts) == 4
    assert (home / "sheet.png").read_bytes().startswith(b"\x89PNG")


def test_sheet_alone(run, cube, home):
    assert run("slices", cube, "--plot", "sheet.exr").stdout == "sheet.exr: contact sheet\n"
    assert {path.name for path in home.iterdir()} == {cube, "sheet.exr"}


def test_an_output_is_required(misuse, cube):
    assert "--plot" in misuse("slices", cube)


@pytest.mark.parametrize("exists", ["out.exr", "sheet.png"])
def test_nothing_is_written_if_one_file_exists(run, refuse, cube, home, exists):
    (home / exists).write_text("old")
    error = refuse("slices", cube, "-o", "out.exr", "--plot", "sheet.png")
    assert (error.code, error.where) == ("file-exists", exists)
    assert {path.name for path in home.iterdir()} == {cube, exists}
    run("slices", cube, "-o", "out.exr", "--plot", "sheet.png", "--force")


def test_invalid_cubes_are_errors(refuse, home):
    (home / "text.uplift").write_text("not a cube")
    assert refuse("slices", "text.uplift", "-o", "out.exr").code == "not-a-cube"
    assert refuse("slices", "missing.uplift", "-o", "out.exr").code == "cube-not-found"
    assert not (home / "out.exr").exists()


def test_help_has_examples(run):
    text = run("slices", "--help").stdout
    assert "    uplift slices macbeth-32.uplift --plot sheet.png" in text.splitlines()
