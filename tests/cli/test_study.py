"""``uplift study``."""

from __future__ import annotations

import csv
import io
import json
import shutil

import matplotlib.image
import pytest

FILES = ["moments-patches.png", "moments-worst.png", "moments.csv", "moments.png"]


@pytest.fixture
def tcs(repository):
    """The smallest atlas."""
    return repository / "atlases" / "tcs.txt"


def test_all_files_are_written(run, home, macbeth, tcs):
    result = run(
        "study",
        "moments",
        "--atlas",
        macbeth,
        "--atlas",
        tcs,
        "-o",
        "out",
        "--format",
        "csv",
        "--max-moments",
        9,
    )
    assert sorted(path.name for path in (home / "out").iterdir()) == FILES
    assert (home / "out" / "moments.csv").read_text(encoding="utf-8") == result.stdout
    assert result.stderr == f"out: {', '.join(['moments.csv', 'moments.png', *FILES[:2]])}\n"
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert len(rows) == 3 * 4 * 10
    (nine,) = [
        row
        for row in rows
        if (row["atlas"], row["mirrored"], row["warped"], row["moments"]) == ("macbeth", "True", "False", "8")
    ]
    assert (nine["entries"], nine["floats"], nine["worst"]) == ("24", "9", "blue flower")
    assert float(nine["delta_e_76_D65_mean"]) == pytest.approx(0.54, abs=0.01)
    assert float(nine["delta_e_76_D65_max"]) == pytest.approx(1.22, abs=0.01)
    for name in FILES:
        if name.endswith(".png"):
            assert matplotlib.image.imread(home / "out" / name).std() > 0.05


def test_json_and_csv_have_the_same_rows(run, tcs):
    args = ("study", "moments", "--atlas", tcs, "--max-moments", 2, "--format")
    objects = json.loads(run(*args, "json").stdout)
    rows = list(csv.DictReader(io.StringIO(run(*args, "csv").stdout)))
    assert [{key: str(value) for key, value in one.items()} for one in objects] == rows
    assert {one["atlas"] for one in objects} == {"all", "tcs"}
    assert objects[2]["floats"] == 3
    assert objects[0].keys() >= {"delta_e_00_FL11_mean", "delta_e_00_LED-B3_max", "rms_mean", "worst"}


def test_table_has_a_line_per_count(run, tcs):
    result = run("study", "moments", "--atlas", tcs, "--max-moments", 4)
    lines = [line.split() for line in result.stdout.splitlines()]
    assert [line[0] for line in lines if line and line[0].isdigit()][:5] == list("01234")
    assert "14 entries" in result.stdout
    assert result.stderr == ""


def test_default_atlases_are_those_of_the_working_folder(run, home, tcs):
    (home / "atlases").mkdir()
    shutil.copy(tcs, home / "atlases")
    rows = csv.DictReader(io.StringIO(run("study", "moments", "--max-moments", 0, "--format", "csv").stdout))
    assert {row["atlas"] for row in rows} == {"all", "tcs"}


def test_shipped_atlases_are_the_default_in_other_folders(run, home, repository):
    rows = csv.DictReader(io.StringIO(run("study", "moments", "--max-moments", 0, "--format", "csv").stdout))
    assert {row["atlas"] for row in rows} == {"all"} | {path.stem for path in (repository / "atlases").glob("*.txt")}


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
        (("--atlas", "none.txt"), "file-not-found"),
        (("--atlas", "tcs.txt", "--max-moments", 33), "moments-out-of-range"),
        (("--atlas", "tcs.txt", "--max-moments", -1), "moments-out-of-range"),
        (("--atlas", "tcs.txt", "--atlas", "copy/tcs.txt"), "atlas"),
        (("--atlas", "tcs.txt", "-o", "file"), "output"),
        (("--atlas", "tcs.txt", "-o", "none/out"), "output"),
    ],
)
def test_invalid_input_is_an_error(refuse, home, tcs, options, code):
    (home / "copy").mkdir()
    shutil.copy(tcs, home / "copy")
    shutil.copy(tcs, home)
    (home / "file").write_text("mine")
    assert refuse("study", "moments", *options).code == code


def test_studies_are_subcommands(run):
    for name in ("moments", "held-out"):
        assert f"\n  {name} " in run("study", "--help").stdout
    run("study", "colours", code=2)


def test_held_out_has_the_same_numbers_in_all_formats(run, tcs):
    args = ("study", "held-out", "--atlas", tcs, "--dim", 4, "--splits", 1, "--format")
    objects = json.loads(run(*args, "json").stdout)
    methods = [
        "half the atlas",
        "without an atlas",
        "sigmoid",
        "local-linear regression",
        "centroid of mismatch",
    ]
    assert [one["cube"] for one in objects] == methods
    assert all(one["atlas"] == "tcs" and 0 < one["rms"] < 0.5 for one in objects[:-1])
    assert objects[-1]["rms"] is None
    rows = list(csv.DictReader(io.StringIO(run(*args, "csv").stdout)))
    assert [float(row["FL11"]) for row in rows] == pytest.approx([one["FL11"] for one in objects])
    table = run(*args, "table")
    assert table.stderr == ""
    assert f"{objects[0]['A']:.3f}" in table.stdout


def test_atlases_too_small_to_split_are_errors(refuse, home):
    lines = [f"{name}," + ",".join(["0.5"] * 31) for name in ("one", "other")]
    header = "name," + ",".join(map(str, range(400, 701, 10)))
    (home / "two.csv").write_text("\n".join([header, *lines]) + "\n")
    error = refuse("study", "held-out", "--atlas", "two.csv", "--dim", 4)
    assert error.code == "too-few-entries"
    assert "2" in error.problem
