"""``uplift report``."""

import json
import re
import shutil

import pytest

SMALL = ("--light", "D65", "--light", "A", "--worst", "2")


@pytest.fixture
def cube(home, cubes, macbeth):
    """A stored cube and its atlas, in the working folder."""
    shutil.copy(macbeth, home)
    shutil.copy(cubes / "moments-8-macbeth.uplift", home / "macbeth-8.uplift")
    return "macbeth-8.uplift"


def test_page_is_written_to_the_working_folder(run, home, cube):
    summary = run("report", cube, *SMALL).stdout
    name = "macbeth-8.html"
    assert summary.startswith(f"{name}: 0 nodes over the threshold, 24 entries, ")
    text = (home / name).read_text("utf-8")
    assert "macbeth-8.uplift" in text
    assert str(home) not in text


def test_json_goes_to_standard_output_or_to_a_file(run, ask, home, cube):
    found = ask("report", cube, *SMALL)
    assert found["lights"] == ["D65", "A"]
    run("report", cube, *SMALL, "--format", "json", "-o", "numbers.json")
    assert json.loads((home / "numbers.json").read_text("utf-8")) == found


def test_another_atlas_tests_unseen_colours(run, repository, cube):
    other = repository / "atlases" / "babelcolor.txt"
    summary = run("report", cube, *SMALL, "--atlas", other).stdout
    assert re.search(r"68 % within \d\.\d\d under A, predicted \d\.\d\d", summary)
