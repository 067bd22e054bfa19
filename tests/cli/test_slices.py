"""``uplift slices``."""

import OpenEXR
import pytest

from tests.cube.hand_made import hand_made
from uplift.cube.file import write


@pytest.fixture
def cube(home):
    """A cube file in the working folder."""
    write(hand_made(), "small.uplift")
    return "small.uplift"


def test_slices_and_sheet(run, cube, home):
    result = run("slices -o out.exr --plot sheet.png", cube)
    assert result.stdout.splitlines() == [
        "out.exr: 4 blue slices",
        "sheet.png: contact sheet",
    ]
    assert len(OpenEXR.File("out.exr").parts) == 4
    assert (home / "sheet.png").read_bytes().startswith(b"\x89PNG")


def test_slices_have_the_name_of_the_cube(run, cube, home):
    assert run("slices", cube).stdout == "small.exr: 4 blue slices\n"
    assert len(OpenEXR.File(str(home / "small.exr")).parts) == 4


def test_builds_for_debugging_write_their_slices(run, refuse, home):
    words = "build --dim 2 --prior smooth --debug"
    summary, slices = run(f"{words} -o two.uplift").stdout.splitlines()
    assert summary.startswith("two.uplift: 2³ nodes, ")
    assert slices == "two.exr: 2 blue slices"
    assert len(OpenEXR.File(str(home / "two.exr")).parts) == 2
    (home / "two.uplift").unlink()
    assert refuse(f"{words} -o two.uplift").where == "two.exr"


def test_bad_input_is_refused(run, refuse, cube, home):
    assert refuse("slices missing.uplift -o out.exr").code == "file-not-found"
    for exists, other in (("out.exr", "sheet.png"), ("sheet.png", "out.exr")):
        (home / exists).write_text("old")
        assert refuse("slices -o out.exr --plot sheet.png", cube).where == exists
        assert not (home / other).exists()
        (home / exists).unlink()
