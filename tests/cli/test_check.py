"""``uplift check``."""

import dataclasses
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import uplift
from tests.helpers import with_points
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


def test_json_has_measures_and_failures(run, stored, modified):
    before = modified.read_bytes()
    good, bad = json.loads(
        run("check", stored, modified, "--format", "json", code=1).stdout
    )
    assert (good["cube"], good["passed"], good["failures"], good["error"]) == (
        str(stored),
        True,
        [],
        None,
    )
    assert good["measures"].keys() == LIMITS.keys()
    assert good["status"]["stored"] == good["status"]["rebuilt"]
    assert (bad["cube"], bad["passed"]) == (str(modified), False)
    assert "spectra_max" in bad["failures"]
    assert modified.read_bytes() == before


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
    assert result.stderr.splitlines() == [
        f"error: {failure.message}" for failure in shown
    ]
    return [(failure.error.code, failure.error.where) for failure in shown]


def test_failed_cubes_do_not_stop_the_others(
    run, shown, home, stored, modified, other_lattice, monkeypatch
):
    monkeypatch.setenv(
        "COLUMNS", "1000"
    )  # one line for each cube, however long its path is
    (home / "text.uplift").write_text("no cube")
    result = run(
        "check none.uplift text.uplift", other_lattice, modified, stored, code=2
    )
    verdicts = {
        line.split()[0]: line.split()[1]
        for line in result.stdout.splitlines()
        if ".uplift" in line
    }
    failed = dict.fromkeys(
        ("none.uplift", "text.uplift", str(other_lattice), str(modified)), "FAILED"
    )
    assert verdicts == failed | {str(stored): "passed"}
    assert reported(result, shown) == [
        ("file-not-found", "none.uplift"),
        ("not-a-cube", "text.uplift"),
        ("cube-file", str(other_lattice)),
    ]


def test_json_has_the_errors_of_failed_cubes(run, other_lattice):
    result = run("check --format json", other_lattice, code=2)
    (failed,) = json.loads(result.stdout)
    assert (failed["passed"], failed["failures"], failed["measures"]) == (
        False,
        ["cube-file"],
        {},
    )
    assert (failed["error"]["code"], failed["error"]["where"], result.stderr) == (
        "cube-file",
        str(other_lattice),
        "",
    )


def test_update_replaces_failed_cubes_that_can_be_rebuilt(
    run, shown, stored, modified, other_lattice
):
    before = stored.read_bytes()
    result = run(
        "check -q --update none.uplift",
        stored,
        modified,
        other_lattice,
        code=2,
    )
    assert [failure.error.code for failure in shown] == ["file-not-found"]
    assert result.stderr.splitlines()[1:] == [
        f"{modified}: replaced",
        f"{other_lattice}: replaced",
    ]
    assert (
        before
        == stored.read_bytes()
        == modified.read_bytes()
        == other_lattice.read_bytes()
    )
    run("check", modified, other_lattice)


def test_atlases_are_searched_for_in_given_folders(
    run, shown, home, monkeypatch, macbeth
):
    monkeypatch.setattr("uplift.extras.report.rebuild.shipped_atlases", tuple)
    with pytest.warns(uplift.UpliftWarning):
        uplift.build(macbeth, dim=3, coefficients=4).save(home / "cube.uplift")
    result = run("check cube.uplift", code=2)
    assert reported(result, shown) == [("atlas-not-found", "cube.uplift")]
    assert "macbeth.txt" in shown.pop().error.problem
    (home / "there").mkdir()
    shutil.copy(macbeth, home / "there")
    assert "passed" in run("check cube.uplift --atlas-dir there").stdout


def test_a_changed_atlas_is_explained_and_the_cube_updated(run, ask, home):
    """One entry has other values and one another name."""
    wavelengths = list(range(380, 781, 10))

    def write(**entries):
        rows = [
            ("name", *wavelengths),
            *((name, *values) for name, values in entries.items()),
        ]
        (home / "mine.csv").write_text(
            "".join(",".join(map(str, row)) + "\n" for row in rows)
        )

    red = np.linspace(0.1, 0.6, 41)
    grey = np.full(41, 0.5)
    dark = np.full(41, 0.3)
    write(red=red, grey=grey, dark=dark)
    uplift.build(home / "mine.csv", dim=9, coefficients=4).save(home / "cube.uplift")
    assert ask("check cube.uplift")[0]["passed"]
    text = (home / "mine.csv").read_bytes()
    (home / "mine.csv").write_bytes(text.replace(b"\n", b"\r\n"))
    (answer,) = ask("check cube.uplift")
    assert (answer["passed"], answer["atlas_changed"]) == (True, [])
    assert len(answer["notes"]) == 1
    write(red=red, grey=grey + 0.02, new=dark)
    (answer,) = ask("check cube.uplift", code=1)
    assert {"atlas-changed", "entries", "delta_e_A"} <= set(answer["failures"])
    changes = {entry["name"]: entry["change"] for entry in answer["entries"]}
    assert changes == {"grey": "moved", "dark": "removed", "new": "added"}
    assert answer["entries"][-1]["delta_e"] > 0.5
    table = run("check cube.uplift", code=1).stdout.split("limit")[0]
    assert table.splitlines()[-1].split()[:3] == ["cube.uplift", "FAILED", "atlas"]
    shown = run("check cube.uplift --update").stdout
    assert "mine.csv" in shown
    assert "grey: moved" in shown
    run("check cube.uplift")


@pytest.mark.parametrize("cube", CUBES, ids=lambda path: path.stem)
def test_stored_cubes_pass(run, cube):
    """Stored cubes equal their rebuilds within the limits, the default cube of the
    package included.
    """
    assert "passed" in run("check", cube).stdout
