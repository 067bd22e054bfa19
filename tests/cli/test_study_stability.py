"""``uplift study stability`` and ``uplift study sensitivity``."""

from __future__ import annotations

import csv
import io
import json
import re

import matplotlib.image

NARROW = ("--dims", 4, "--coefficients", "9", "--models", "moments", "--spaces", "sRGB", "--samples", 1)


def test_all_files_are_written(run, home, repository):
    tcs = repository / "atlases" / "tcs.txt"
    few = ("--thresholds", "1e-3,1e-4", "--atlas", tcs, "--atlases", "none,tcs")
    rest = (*few, "-o", "out", "--format", "csv")
    result = run("study", "stability", *NARROW, *rest)
    assert result.stderr == "out: stability.csv, stability.json, stability.png\n"
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert (home / "out" / "stability.csv").read_text(encoding="utf-8") == result.stdout
    objects = json.loads((home / "out" / "stability.json").read_text(encoding="utf-8"))
    assert [{key: str(value) for key, value in one.items()} for one in objects] == rows
    assert {one["atlas"] for one in objects} == {"none", "tcs"}
    assert all(one["success"] == 1 and one["worst"] <= one["threshold"] for one in objects)
    assert matplotlib.image.imread(home / "out" / "stability.png").std() > 0.05


def test_table_counts_failures(run):
    args = ("--thresholds", "1e-4", "--samples", 0, "--atlases", "none")
    result = run("study", "stability", *NARROW[:-2], *args)
    lines = result.stdout.splitlines()
    assert any("moments 9" in line for line in lines)
    assert re.fullmatch(r"1 builds, \d+ realisable nodes: \d+ unfitted in \d+ builds", lines[-1])


def test_invalid_lists_are_errors(misuse, refuse):
    assert "'4,x'" in misuse("study", "stability", "--dims", "4,x")
    error = refuse("study", "stability", *NARROW, "--atlases", "none,moon")
    assert error.code == "unknown-atlas"
    assert "'moon'" in error.problem


def test_sensitivity_of_a_stored_cube(run, home, cubes):
    cube = cubes / "moments-8-macbeth.uplift"
    args = ("study", "sensitivity", cube, "--entries", 1)
    record = json.loads(run(*args, "-o", "out", "--format", "json").stdout)
    assert json.loads((home / "out" / "sensitivity.json").read_text(encoding="utf-8")) == record
    changes = [one["change"] for one in record["changes"]]
    assert len(changes) == 5
    assert all("dark skin" in change for change in changes[3:])
    for name in ("steepness", "locality"):
        assert matplotlib.image.imread(home / "out" / f"sensitivity-{name}.png").std() > 0.05


def test_cells_whose_answers_are_moved_are_counted(run, home):
    run("build", "--space", "ITU-R BT.2020", "--dim", 3, "-o", "wide.uplift")
    assert re.search(r"in [1-8] cells, which have corners", run("study", "sensitivity", "wide.uplift").stdout)


def test_sensitivity_of_the_packaged_cube_has_no_changes_of_an_atlas(run, home):
    result = run("study", "sensitivity", "-o", "out")
    assert "cells, which" not in result.stdout
    assert "Lipschitz constant" in result.stdout
    assert "left out" not in result.stdout
    assert result.stderr == "out: sensitivity.json, sensitivity-steepness.png\n"
