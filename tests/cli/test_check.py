"""``uplift check``: 0 where all is as stored, 1 where it is not, 2 where it cannot be told."""

from __future__ import annotations

import dataclasses
import json
import shutil

import pytest
from click.testing import CliRunner
from uplift_cli.main import main

import uplift
from uplift.cube import read, write

from .conftest import MACBETH, SIGMOID, SMALL


@pytest.fixture
def nudged(elsewhere):
    """A stored cube with one coefficient changed, and a digest that fits it."""
    data = read(SIGMOID)
    coefficients = data.coefficients.copy()
    coefficients[100, 1] += 0.01
    write(dataclasses.replace(data, coefficients=coefficients), elsewhere / "nudged.uplift")
    return elsewhere / "nudged.uplift"


def test_the_stored_cubes_are_what_is_built_today(run):
    out = run("check", SMALL, SIGMOID, "--format", "json").stdout
    assert [(row["passed"], row["failures"]) for row in json.loads(out)] == [(True, [])] * 2


def test_the_table_names_cube_measures_and_verdict(run):
    out = run("check", SIGMOID).stdout
    for text in ("cube", "RGB", "ΔE00 FL11", "sigmoid-8.uplift", "passed", "limit"):
        assert text in out


def test_one_nudged_coefficient_is_exit_code_1(nudged):
    result = CliRunner().invoke(main, ["check", SIGMOID, str(nudged), "--format", "json"])
    assert result.exit_code == 1
    passed, failed = json.loads(result.stdout)
    assert passed["passed"]
    assert not failed["passed"]
    assert "spectra_max" in failed["failures"]
    assert "FAILED" in CliRunner().invoke(main, ["check", str(nudged)]).stdout


def test_update_replaces_what_differs_and_nothing_else(run, nudged, elsewhere):
    shutil.copyfile(SIGMOID, elsewhere / "fine.uplift")
    before = (elsewhere / "fine.uplift").stat().st_mtime_ns
    result = run("check", nudged, "fine.uplift", "--update")
    assert result.stderr == f"{nudged}: replaced\n"
    assert (elsewhere / "fine.uplift").stat().st_mtime_ns == before
    run("check", nudged)


def test_quiet_is_quiet(run):
    result = run("check", SIGMOID, "-q")
    assert (result.stdout, result.stderr) == ("", "")


def test_an_atlas_that_is_not_there_cannot_be_checked(run, refused, elsewhere):
    shutil.copyfile(SMALL, elsewhere / "cube.uplift")
    assert "its atlas 'macbeth.txt' is not to be found" in refused("check", "cube.uplift")
    run("check", "cube.uplift", "--atlas-dir", MACBETH.rsplit("/", 1)[0])


def test_what_is_no_cube_is_refused(refused, elsewhere):
    (elsewhere / "a.uplift").write_text("no cube")
    assert "a.uplift" in refused("check", SIGMOID, "a.uplift")


def test_a_cube_made_in_python_from_no_file_says_so(refused, elsewhere):
    uplift.build(uplift.Spectra(), dim=2).save("fine.uplift")
    data = read("fine.uplift")
    sourced = {**data.provenance, "atlases": [{"name": "distributions", "digest": "0"}]}
    write(dataclasses.replace(data, provenance=sourced), "python.uplift")
    assert "its atlas 'distributions' is not to be found" in refused("check", "python.uplift")
