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
    run("slices", cube)
    run("slices --plot sheet.png", cube)
    assert len(OpenEXR.File("small.exr").parts) == 4
    assert (home / "sheet.png").read_bytes().startswith(b"\x89PNG")


def test_builds_for_debugging_write_their_slices(run, refuse, home):
    words = "build --dim 2 --prior smooth --debug -o two.uplift"
    assert "two.exr: 2 blue slices" in run(words).stdout
    assert len(OpenEXR.File("two.exr").parts) == 2
    (home / "two.uplift").unlink()
    assert refuse(words).where == "two.exr"
