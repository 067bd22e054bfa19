"""``uplift check``."""

from __future__ import annotations

import dataclasses
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import uplift
from tests.helpers import with_points
from uplift.cube import write
from uplift.lattice import Lattice
from uplift.report.regression import LIMITS

ROOT = Path(__file__).parents[2]
CUBES = [*sorted((ROOT / "cubes").glob("*.uplift")), ROOT / "uplift" / "lookup" / "default.uplift"]


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
    result = run("check", modified.name, code=1)
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


@pytest.fixture
def other_lattice(home, stored):
    """The same cube on another lattice than its options give."""
    data = uplift.load(stored).data
    nodes = data.lattice.nodes.copy()
    nodes[1] += 1e-9
    write(dataclasses.replace(data, lattice=Lattice(nodes)), home / "lattice.uplift")
    return home / "lattice.uplift"


def reported(result, shown):
    """Codes and locations of the errors on standard error, one line each."""
    assert result.stderr.splitlines() == [f"error: {failure.message}" for failure in shown]
    return [(failure.error.code, failure.error.where) for failure in shown]


def test_failed_cubes_do_not_stop_the_others(run, shown, home, stored, modified, other_lattice, monkeypatch):
    monkeypatch.setenv("COLUMNS", "1000")  # one line for each cube, however long its path is
    (home / "text.uplift").write_text("no cube")
    result = run("check", "none.uplift", "text.uplift", other_lattice, modified, stored, code=1)
    verdicts = {line.split()[0]: line.split()[-1] for line in result.stdout.splitlines() if ".uplift" in line}
    failed = dict.fromkeys(("none.uplift", "text.uplift", str(other_lattice), str(modified)), "FAILED")
    assert verdicts == failed | {str(stored): "passed"}
    assert reported(result, shown) == [
        ("cube-not-found", "none.uplift"),
        ("not-a-cube", "text.uplift"),
        ("lattice-mismatch", str(other_lattice)),
    ]


def test_json_has_the_errors_of_failed_cubes(run, stored, other_lattice):
    result = run("check", "none.uplift", other_lattice, stored, "--format", "json", code=1)
    assert result.stderr == ""
    missing, lattice, good = json.loads(result.stdout)
    for failed, code, path in (
        (missing, "cube-not-found", "none.uplift"),
        (lattice, "lattice-mismatch", str(other_lattice)),
    ):
        assert (failed["cube"], failed["passed"], failed["failures"]) == (path, False, [code])
        assert (failed["error"]["code"], failed["error"]["where"]) == (code, path)
        assert failed["measures"] == failed["status"] == {}
    assert (good["passed"], good["error"]) == (True, None)


def test_update_replaces_cubes_with_another_lattice(run, stored, other_lattice):
    assert not np.array_equal(uplift.load(other_lattice).data.lattice.nodes, uplift.load(stored).data.lattice.nodes)
    result = run("check", "--update", other_lattice)
    assert result.stderr == f"{other_lattice}: replaced\n"
    assert other_lattice.read_bytes() == stored.read_bytes()
    run("check", other_lattice)


def test_update_replaces_the_others_if_a_cube_cannot_be_read(run, shown, stored, modified):
    result = run("check", "-q", "--update", "none.uplift", modified, code=1)
    assert [failure.error.code for failure in shown] == ["cube-not-found"]
    assert result.stderr.splitlines()[1:] == [f"{modified}: replaced"]
    assert modified.read_bytes() == stored.read_bytes()


def test_atlases_are_searched_for_in_given_folders(run, shown, home, monkeypatch, macbeth, recwarn):
    monkeypatch.setattr("uplift.pipeline.rebuild.shipped_atlases", tuple)
    with pytest.warns(uplift.UpliftWarning):
        uplift.build(macbeth, dim=3, coefficients=4).save(home / "cube.uplift")
    result = run("check", "cube.uplift", code=1)
    assert reported(result, shown) == [("atlas-not-found", "cube.uplift")]
    assert "macbeth.txt" in shown.pop().error.problem
    (home / "there").mkdir()
    shutil.copy(macbeth, home / "there")
    assert "passed" in run("check", "cube.uplift", "--atlas-dir", "there").stdout
    (home / "there" / "macbeth.txt").write_text("Entry ID: changed\n")
    result = run("check", "cube.uplift", "--atlas-dir", "there", code=1)
    assert [code for code, _ in reported(result, shown)] == ["atlas-changed"]


def test_shipped_atlases_are_found_in_any_folder(run, home, cubes):
    shutil.copy(cubes / "moments-8-macbeth.uplift", home)
    assert "passed" in run("check", "moments-8-macbeth.uplift").stdout


@pytest.mark.parametrize("cube", CUBES, ids=lambda path: path.stem)
def test_stored_cubes_pass(run, cube):
    """Stored cubes equal their rebuilds within the limits, the default cube of the package included."""
    assert "passed" in run("check", cube, "--atlas-dir", ROOT / "atlases").stdout
