"""``uplift check``."""

from __future__ import annotations

import importlib
import json
import shutil

import pytest

import uplift
from tests.helpers import with_points
from uplift.cube import write
from uplift.report.regression import LIMITS


@pytest.fixture
def stored(home):
    """A cube of dim 3 without an atlas."""
    uplift.build(dim=3, coefficients=4).save(home / "cube.uplift")
    return home / "cube.uplift"


@pytest.fixture
def modified(home, stored):
    """The same cube with one changed coefficient and a valid digest."""
    data = uplift.load(stored).data
    coefficients = data.points.coefficients.copy()
    coefficients[13, 2] += 1e-3
    write(with_points(data, coefficients=coefficients), home / "modified[red].uplift")
    return home / "modified[red].uplift"


def test_unchanged_cube_passes(run, stored):
    result = run("check", stored)
    assert "passed" in result.stdout
    assert "FAILED" not in result.stdout
    assert result.stderr == ""


def test_modified_cube_fails_with_exit_code_1_and_stays(run, modified):
    before = modified.read_bytes()
    result = run("check", modified, code=1)
    assert "FAILED" in result.stdout
    assert "modified[red].uplift" in result.stdout
    assert result.stderr == ""
    assert modified.read_bytes() == before


def test_json_has_measures_and_failures(run, stored, modified):
    good, bad = json.loads(run("check", stored, modified, "--format", "json", code=1).stdout)
    assert (good["cube"], good["passed"], good["failures"]) == (str(stored), True, [])
    assert good["measures"].keys() == LIMITS.keys()
    assert good["status"]["stored"] == good["status"]["rebuilt"]
    assert (bad["cube"], bad["passed"]) == (str(modified), False)
    assert "spectra_max" in bad["failures"]


def test_quiet_prints_nothing(run, stored, modified):
    for path, code in ((stored, 0), (modified, 1)):
        result = run("check", "-q", path, code=code)
        assert (result.stdout, result.stderr) == ("", "")


def test_verbose_prints_progress(run, stored):
    result = run("check", "-v", stored)
    assert result.stderr.startswith("fitting: ")
    assert "storing: " in result.stderr


def test_update_replaces_only_cubes_that_differ(run, stored, modified):
    before = stored.read_bytes()
    result = run("check", "--update", stored, modified)
    assert result.stderr == f"{modified}: replaced\n"
    assert stored.read_bytes() == before
    assert modified.read_bytes() == before
    run("check", modified)


def test_atlases_are_searched_for_in_given_folders(run, refuse, home, monkeypatch, macbeth, recwarn):
    monkeypatch.setattr("uplift.pipeline.provenance.shipped_atlases", tuple)
    with pytest.warns(uplift.UpliftWarning):
        uplift.build(macbeth, dim=3, coefficients=4).save(home / "cube.uplift")
    error = refuse("check", "cube.uplift")
    assert (error.code, str(error.path)) == ("atlas-not-found", "cube.uplift")
    assert "macbeth.txt" in error.problem
    (home / "there").mkdir()
    shutil.copy(macbeth, home / "there")
    assert "passed" in run("check", "cube.uplift", "--atlas-dir", "there").stdout
    (home / "there" / "macbeth.txt").write_text("Entry ID: changed\n")
    assert refuse("check", "cube.uplift", "--atlas-dir", "there").code == "atlas-changed"


def test_shipped_atlases_are_found_in_any_folder(run, home, cubes):
    shutil.copy(cubes / "moments-8-macbeth.uplift", home)
    assert "passed" in run("check", "moments-8-macbeth.uplift").stdout


def test_invalid_cubes_are_reported_before_any_build(refuse, stored, monkeypatch):
    module = importlib.import_module("uplift.pipeline.rebuild")
    monkeypatch.setattr(module, "rebuild", lambda *_, **__: pytest.fail("rebuilt"))
    error = refuse("check", stored, "none.uplift")
    assert (error.code, error.where) == ("cube-not-found", "none.uplift")
