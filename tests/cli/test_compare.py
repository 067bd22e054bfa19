"""``uplift compare``."""

from __future__ import annotations

import csv
import json

import pytest
from click.testing import CliRunner
from uplift_cli.main import main

from uplift.lab.timing import ONE_THREAD

FILES = ["compare-boxes.png", "compare-cost.png", "compare-filters.csv", "compare.csv", "compare.html"]


@pytest.fixture(scope="module")
def quick(repository, tmp_path_factory):
    """A quick comparison on the ColorChecker, filters and all: the folder, and what was said."""
    folder = tmp_path_factory.mktemp("compare")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, value in ONE_THREAD.items():
            patch.setenv(name, value)  # to be taken back
        atlas = str(repository / "atlases" / "macbeth.txt")
        words = ["compare", "--quick", "--filters", "--atlas", atlas, "-o", "out"]
        result = CliRunner().invoke(main, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return folder / "out", result


@pytest.fixture(autouse=True)
def threads(monkeypatch):
    """What the command sets for its process is taken back."""
    for name, value in ONE_THREAD.items():
        monkeypatch.setenv(name, value)


def test_everything_is_written_and_told(quick):
    folder, result = quick
    assert sorted(path.name for path in folder.iterdir()) == FILES
    assert "ΔE00 under smooth lights (A, B, C)" in result.stdout
    assert "ΔE00 under spiky lights (FL2, FL7, FL11)" in result.stdout
    assert "best low-pass filter of each kind" in result.stdout
    assert result.stderr.startswith("out: compare.csv")


def test_the_tables_hold_every_representation_and_filter(quick):
    def read(name):
        with (quick[0] / name).open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    rows = read("compare.csv")
    assert {row["lights"] for row in rows} == {"smooth", "spiky"}
    assert len({row["representation"] for row in rows}) == len(rows) / 2 == 36
    assert len(read("compare-filters.csv")) == 2 * 3 * 9


def test_the_page_has_both_pictures_and_the_filters(quick):
    text = (quick[0] / "compare.html").read_text(encoding="utf-8")
    assert text.count("<svg") == 2
    assert "Low-pass filters, spiky lights" in text


def test_a_target_names_the_cheapest_for_each_set(run, macbeth):
    words = ["compare", "--quick", "--atlas", macbeth, "--target"]
    near = run(*words, 1.0).stdout.splitlines()
    assert [line.split(" lights")[0] for line in near] == ["smooth", "spiky"]
    assert all("97.5 % within" in line and "floats a surface" in line for line in near)
    (far,) = run(*words, 0.001, "--light", "FL11").stdout.splitlines()
    assert far.startswith("given lights (FL11): none; the nearest, ")


def test_other_lights_take_the_place_of_the_sets(run, macbeth):
    words = ["--light", "LED-B3", "--light", "HP1", "--format", "json"]
    told = json.loads(run("compare", "--quick", "--atlas", macbeth, *words).stdout)
    assert {row["lights"] for row in told["representations"]} == {"given"}
    assert told["facts"]["products"] == "24 surfaces under each light"
    assert told["filters"] == []


def test_bad_input_is_refused(run, refuse, home, macbeth):
    assert refuse("compare").startswith("there are no atlases/*.txt here")
    assert "did you mean 'FL2'" in refuse("compare", "--atlas", macbeth, "--light", "F2")
    assert "a target of 0 is none" in refuse("compare", "--atlas", macbeth, "--target", 0)
    (home / "file").write_text("mine")
    assert "cannot be created" in refuse("compare", "--atlas", macbeth, "-o", "file")
    (home / "out").mkdir()
    (home / "out" / "compare.csv").write_text("mine")
    assert "exists already; use --force" in refuse("compare", "--atlas", macbeth, "-o", "out")
