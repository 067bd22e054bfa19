"""``uplift check``."""

from __future__ import annotations

import json
import shutil

import pytest

import uplift
from tests.helpers import with_points
from uplift.cube import write
from uplift.report.regression import LIMITS


@pytest.fixture
def stored(home):
    """A cube of dim 3 without an atlas, built here."""
    uplift.build(dim=3, coefficients=4).save(home / "cube.uplift")
    return home / "cube.uplift"


@pytest.fixture
def spoilt(home, stored):
    """The same cube, one coefficient nudged, its digest right."""
    data = uplift.load(stored).data
    coefficients = data.points.coefficients.copy()
    coefficients[13, 2] += 1e-3
    write(with_points(data, coefficients=coefficients), home / "spoilt[red].uplift")
    return home / "spoilt[red].uplift"


def test_a_cube_as_it_was_built_passes(run, stored):
    result = run("check", stored)
    assert "passed" in result.stdout
    assert "FAILED" not in result.stdout
    assert result.stderr == ""


def test_a_spoilt_cube_fails_with_code_1_and_is_left_alone(run, spoilt):
    before = spoilt.read_bytes()
    result = run("check", spoilt, code=1)
    assert "FAILED" in result.stdout
    assert "spoilt[red].uplift" in result.stdout
    assert result.stderr == ""
    assert spoilt.read_bytes() == before


def test_json_names_every_measure_and_what_failed(run, stored, spoilt):
    good, bad = json.loads(run("check", stored, spoilt, "--format", "json", code=1).stdout)
    assert (good["cube"], good["passed"], good["failures"]) == (str(stored), True, [])
    assert good["measures"].keys() == LIMITS.keys()
    assert good["status"]["stored"] == good["status"]["rebuilt"]
    assert (bad["cube"], bad["passed"]) == (str(spoilt), False)
    assert "spectra_max" in bad["failures"]


def test_quiet_says_it_by_the_code_alone(run, stored, spoilt):
    for path, code in ((stored, 0), (spoilt, 1)):
        result = run("check", "-q", path, code=code)
        assert (result.stdout, result.stderr) == ("", "")


def test_verbose_tells_the_rounds(run, stored):
    result = run("check", "-v", stored)
    assert result.stderr.startswith("round 0: tried ")


def test_update_replaces_what_differs_and_nothing_else(run, stored, spoilt):
    before = stored.read_bytes()
    result = run("check", "--update", stored, spoilt)
    assert result.stderr == f"{spoilt}: replaced\n"
    assert stored.read_bytes() == before
    assert spoilt.read_bytes() == before
    run("check", spoilt)


def test_atlases_are_looked_for_in_the_folders_named(run, refuse, home, macbeth, recwarn):
    with pytest.warns(uplift.UpliftWarning):
        uplift.build(macbeth, dim=3, coefficients=4).save(home / "cube.uplift")
    message = refuse("check", "cube.uplift")
    assert message.startswith(
        "cube.uplift: its atlas 'macbeth.txt' is not to be found; name the folder with --atlas"
    )
    (home / "there").mkdir()
    shutil.copy(macbeth, home / "there")
    assert "passed" in run("check", "cube.uplift", "--atlas-dir", "there").stdout
    (home / "there" / "macbeth.txt").write_text("Entry ID: changed\n")
    assert "has changed" in refuse("check", "cube.uplift", "--atlas-dir", "there")


def test_one_file_that_is_no_cube_refuses_all_before_building(refuse, stored):
    assert refuse("check", stored, "none.uplift") == "none.uplift: no such file; 'uplift build' makes cubes"
