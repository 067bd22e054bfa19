"""``uplift study``."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil

import matplotlib.image
import pytest

SETTINGS = ("--dims", 4, "--coefficients", "9", "--models", "moments", "--spaces", "sRGB")
METHODS = ["half the atlas", "without an atlas", "sigmoid", "local-linear regression", "centroid of mismatch"]


@pytest.fixture
def tcs(repository):
    """The smallest atlas."""
    return repository / "atlases" / "tcs.txt"


@pytest.fixture
def rows(run):
    """Rows of the CSV on standard output."""
    return lambda *args: list(csv.DictReader(io.StringIO(run("study", *args, "--format", "csv").stdout)))


def check_files(folder, names):
    """Every picture shows something, and no other file is there."""
    assert sorted(path.name for path in folder.iterdir()) == sorted(names)
    for name in names:
        if name.endswith(".png"):
            assert matplotlib.image.imread(folder / name).std() > 0.05


def as_text(objects):
    return [{key: str(value) for key, value in one.items()} for one in objects]


def test_moments(run, home, macbeth, tcs):
    """The errors of nine floats are those of table 4.1 of the thesis."""
    words = ("study", "moments", "--atlas", macbeth, "--atlas", tcs, "--max-moments", 9)
    result = run(*words, "-o", "out", "--format", "csv")
    names = ["moments.csv", "moments.png", "moments-patches.png", "moments-worst.png"]
    check_files(home / "out", names)
    assert result.stderr == f"out: {', '.join(names)}\n"
    assert (home / "out" / "moments.csv").read_text(encoding="utf-8") == result.stdout
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert len(rows) == 3 * 4 * 10
    key = ("macbeth", "True", "False", "8")
    (nine,) = [row for row in rows if (row["atlas"], row["mirrored"], row["warped"], row["moments"]) == key]
    assert (nine["entries"], nine["floats"], nine["worst"]) == ("24", "9", "blue flower")
    assert float(nine["delta_e_76_D65_mean"]) == pytest.approx(0.54, abs=0.01)
    assert float(nine["delta_e_76_D65_max"]) == pytest.approx(1.22, abs=0.01)
    assert as_text(json.loads(run(*words, "--format", "json").stdout)) == rows
    lines = [line.split() for line in run(*words).stdout.splitlines()]
    assert [line[0] for line in lines if line and line[0].isdigit()][:10] == list("0123456789")


def test_default_atlases_are_those_of_the_working_folder_or_the_shipped_ones(rows, home, tcs):
    shipped = {path.stem for path in tcs.parent.glob("*.txt")}
    assert {row["atlas"] for row in rows("moments", "--max-moments", 0)} == {"all"} | shipped
    (home / "atlases").mkdir()
    shutil.copy(tcs, home / "atlases")
    assert {row["atlas"] for row in rows("moments", "--max-moments", 0)} == {"all", "tcs"}


def test_few_entries_and_few_moments_are_drawn_too(run, home):
    (home / "greys.csv").write_text("name,400,500,600,700\ngrey,0.5,0.5,0.5,0.5\n")
    run("study", "moments", "--atlas", "greys.csv", "--max-moments", 0, "-o", ".")
    assert matplotlib.image.imread(home / "moments-worst.png").size


def test_files_are_replaced_only_with_force(run, refuse, home, tcs):
    args = ("study", "moments", "--atlas", tcs, "--max-moments", 1, "-o", home)
    (home / "moments-worst.png").write_text("mine")
    error = refuse(*args)
    assert (error.code, error.path.name) == ("file-exists", "moments-worst.png")
    assert (home / "moments-worst.png").read_text() == "mine"
    assert not (home / "moments.csv").exists()
    run(*args, "--force")
    assert matplotlib.image.imread(home / "moments-worst.png").size


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (("moments", "--atlas", "none.txt"), "file-not-found"),
        (("moments", "--atlas", "tcs.txt", "--max-moments", 33), "moments-out-of-range"),
        (("moments", "--atlas", "tcs.txt", "--max-moments", -1), "moments-out-of-range"),
        (("moments", "--atlas", "tcs.txt", "--atlas", "copy/tcs.txt"), "atlas"),
        (("moments", "--atlas", "tcs.txt", "-o", "file"), "output"),
        (("moments", "--atlas", "tcs.txt", "-o", "none/out"), "output"),
        (("held-out", "--atlas", "two.csv", "--dim", 4), "too-few-entries"),
        (("stability", *SETTINGS, "--atlases", "none,moon"), "unknown-atlas"),
    ],
)
def test_invalid_input_is_an_error(refuse, home, tcs, options, code):
    (home / "copy").mkdir()
    shutil.copy(tcs, home / "copy")
    shutil.copy(tcs, home)
    (home / "file").write_text("mine")
    (home / "two.csv").write_text("name,400,550,700\none,0.5,0.5,0.5\nother,0.4,0.4,0.4\n")
    assert refuse("study", *options).code == code


def test_invalid_lists_are_errors(misuse):
    assert "'4,x'" in misuse("study", "stability", "--dims", "4,x")


def test_held_out_has_the_same_numbers_in_all_formats(run, rows, tcs):
    args = ("held-out", "--atlas", tcs, "--dim", 4, "--splits", 1)
    objects = json.loads(run("study", *args, "--format", "json").stdout)
    assert [one["cube"] for one in objects] == METHODS
    assert all(one["atlas"] == "tcs" and 0 < one["rms"] < 0.5 for one in objects[:-1])
    assert objects[-1]["rms"] is None
    assert [float(row["FL11"]) for row in rows(*args)] == pytest.approx([one["FL11"] for one in objects])
    table = run("study", *args)
    assert table.stderr == ""
    assert f"{objects[0]['A']:.3f}" in table.stdout


def test_stability(run, home, tcs):
    few = ("--thresholds", "1e-3,1e-4", "--samples", 1, "--atlas", tcs, "--atlases", "none,tcs")
    result = run("study", "stability", *SETTINGS, *few, "-o", "out", "--format", "csv")
    names = ["stability.csv", "stability.json", "stability.png"]
    check_files(home / "out", names)
    assert result.stderr == f"out: {', '.join(names)}\n"
    assert (home / "out" / "stability.csv").read_text(encoding="utf-8") == result.stdout
    objects = json.loads((home / "out" / "stability.json").read_text(encoding="utf-8"))
    assert as_text(objects) == list(csv.DictReader(io.StringIO(result.stdout)))
    assert {one["atlas"] for one in objects} == {"none", "tcs"}
    assert all(one["success"] == 1 and one["worst"] <= one["threshold"] for one in objects)


def test_table_of_stability_counts_failures(run):
    result = run("study", "stability", *SETTINGS, "--thresholds", "1e-4", "--samples", 0, "--atlases", "none")
    lines = result.stdout.splitlines()
    assert any("moments 9" in line for line in lines)
    assert re.fullmatch(r"1 builds, \d+ realisable nodes: \d+ unfitted in \d+ builds", lines[-1])


def test_sensitivity_of_a_stored_cube(run, home, cubes):
    args = ("study", "sensitivity", cubes / "moments-8-macbeth.uplift", "--entries", 1)
    record = json.loads(run(*args, "-o", "out", "--format", "json").stdout)
    check_files(home / "out", ["sensitivity.json", "sensitivity-steepness.png", "sensitivity-locality.png"])
    assert json.loads((home / "out" / "sensitivity.json").read_text(encoding="utf-8")) == record
    changes = [one["change"] for one in record["changes"]]
    assert len(changes) == 5
    assert all("dark skin" in change for change in changes[3:])


def test_cells_whose_answers_are_moved_are_counted(run, home):
    run("build", "--space", "ITU-R BT.2020", "--dim", 3, "-o", "wide.uplift")
    assert re.search(r"in [1-8] cells, which have corners", run("study", "sensitivity", "wide.uplift").stdout)


def test_sensitivity_of_the_packaged_cube_has_no_changes_of_an_atlas(run, home):
    result = run("study", "sensitivity", "-o", "out")
    assert "Lipschitz constant" in result.stdout
    assert "left out" not in result.stdout
    assert result.stderr == "out: sensitivity.json, sensitivity-steepness.png\n"
