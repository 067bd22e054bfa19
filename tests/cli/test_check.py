"""``uplift check``."""

import dataclasses
import json
import shutil
from pathlib import Path

import pytest

import uplift
from tests.helpers import quiet_build, with_points
from uplift.cube.file import write
from uplift.extras.report.regression import LIMITS
from uplift.lattice.lattice import Lattice

ROOT = Path(__file__).parents[2]
CUBES = [
    *sorted((ROOT / "cubes").glob("*.uplift")),
    ROOT / "uplift" / "lookup" / "default.uplift",
    ROOT / "docs" / "conformance" / "conformance.uplift",
]


@pytest.fixture(scope="module")
def cube():
    """Dim 3 without an atlas."""
    return uplift.build(dim=3, coefficients=4)


@pytest.fixture
def stored(home, cube):
    cube.save(home / "cube.uplift")
    return home / "cube.uplift"


@pytest.fixture
def modified(home, stored):
    """The same cube with one changed coefficient and a valid digest."""
    data = uplift.load(stored).data
    coefficients = data.points.coefficients.copy()
    coefficients[13, 2] += 1e-3
    write(with_points(data, coefficients=coefficients), home / "modified[red].uplift")
    return home / "modified[red].uplift"


@pytest.fixture
def other_lattice(home, stored):
    """The same cube on another lattice than its options give."""
    data = uplift.load(stored).data
    nodes = data.lattice.nodes.copy()
    nodes[1] += 1e-9
    write(dataclasses.replace(data, lattice=Lattice(nodes)), home / "lattice.uplift")
    return home / "lattice.uplift"


def test_failed_cubes_do_not_stop_the_others(
    run, shown, home, stored, modified, other_lattice
):
    (home / "text.uplift").write_text("no cube")
    cubes = ("none.uplift", "text.uplift", other_lattice.name, modified.name)
    result = run("check --format json", *cubes, stored.name, code=2)
    *failed, lattice, bad, good = json.loads(result.stdout)
    assert [answer["passed"] for answer in failed] == [False, False]
    assert (lattice["passed"], lattice["measures"]) == (False, {})
    assert lattice["error"]["code"] == "cube-file"
    assert lattice["error"]["where"] == other_lattice.name
    assert (bad["passed"], good["passed"]) == (False, True)
    assert "spectra_max" in bad["failures"]
    assert good["measures"].keys() == LIMITS.keys()
    assert good["status"]["stored"] == good["status"]["rebuilt"]
    shown.clear()
    text = run("check", *cubes, stored.name, code=2).stdout
    assert (text.count("FAILED"), text.count("passed")) == (4, 1)
    codes = [failure.error.code for failure in shown]
    assert codes == ["file-not-found", "not-a-cube", "cube-file"]


def test_update_replaces_failed_cubes_that_can_be_rebuilt(
    run, shown, stored, modified, other_lattice
):
    before = stored.read_bytes()
    paths = (stored, modified, other_lattice)
    run("check -q --update none.uplift", *paths, code=2)
    assert [failure.error.code for failure in shown] == ["file-not-found"]
    assert [path.read_bytes() for path in paths] == [before] * 3


def test_atlases_are_searched_for_in_given_folders(run, home, monkeypatch, macbeth):
    monkeypatch.setattr("uplift.extras.report.rebuild.shipped_atlases", tuple)
    quiet_build(macbeth, dim=3, coefficients=4).save(home / "cube.uplift")
    (failed,) = json.loads(run("check cube.uplift --format json", code=2).stdout)
    assert failed["error"]["code"] == "atlas-not-found"
    (home / "there").mkdir()
    shutil.copy(macbeth, home / "there")
    assert "passed" in run("check cube.uplift --atlas-dir there").stdout


def test_a_changed_atlas_is_explained_and_the_cube_updated(run, ask, home):
    """One entry has other values and one another name."""
    file = home / "mine.csv"
    text = "name,380,500,600,780\nred,0.1,0.1,0.4,0.6\ngrey,0.5,0.5,0.5,0.5\n"
    text += "dark,0.3,0.3,0.3,0.3\n"
    file.write_text(text)
    uplift.build(file, dim=9, coefficients=4).save(home / "cube.uplift")
    file.write_text(text, newline="\r\n")
    (answer,) = ask("check cube.uplift")
    assert (answer["passed"], answer["atlas_changed"]) == (True, [])
    assert len(answer["notes"]) == 1
    file.write_text(text.replace("0.5", "0.52").replace("dark", "new"))
    (answer,) = ask("check cube.uplift", code=1)
    assert {"atlas-changed", "entries", "delta_e_A"} <= set(answer["failures"])
    changes = {entry["name"]: entry["change"] for entry in answer["entries"]}
    assert changes == {"grey": "moved", "dark": "removed", "new": "added"}
    assert answer["entries"][-1]["delta_e"] > 0.5
    assert "grey: moved" in run("check cube.uplift --update").stdout
    run("check cube.uplift")


@pytest.mark.parametrize("cube", CUBES, ids=lambda path: path.stem)
def test_stored_cubes_pass(run, cube):
    """Stored cubes equal their rebuilds within the limits, the default cube of the
    package included.
    """
    assert "passed" in run("check", cube).stdout
