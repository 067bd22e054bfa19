"""``uplift lab compare``."""

import csv
import json
import os
import re
from functools import cache

import matplotlib.image
import pytest
from click.testing import CliRunner
from uplift_cli.commands import compare
from uplift_cli.main import main

from uplift.atlas.sources import read_atlas
from uplift.extras.emission.lamps import read_lamps
from uplift.extras.timing import ONE_THREAD

FILES = ["compare-boxes.png", "compare-cost.png", "compare.html"]
measure = cache(compare._measure)
GIVEN = ("--light", "LED-B3", "--light", "HP1")


@pytest.fixture(scope="module")
def quick(repository, tmp_path_factory):
    """A quick comparison on the ColorChecker with filters: its folder and the result of
    the command.
    """
    folder = tmp_path_factory.mktemp("compare")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(compare, "_measure", measure)
        for name, value in ONE_THREAD.items():
            patch.setenv(name, value)
        atlas = str(repository / "atlases" / "macbeth.txt")
        words = [
            "lab",
            "compare",
            "--quick",
            "--filters",
            "--atlas",
            atlas,
            "-o",
            "out",
        ]
        result = CliRunner().invoke(main, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return folder / "out", result


@pytest.fixture(autouse=True)
def once(monkeypatch):
    """Restore the environment that the command changes, and repeat no measurement."""
    monkeypatch.setattr(compare, "_measure", measure)
    for name, value in ONE_THREAD.items():
        monkeypatch.setenv(name, value)


def test_all_files_are_written_and_tables_printed(quick):
    folder, result = quick
    assert sorted(os.listdir(folder)) == FILES
    for name in FILES[:2]:
        assert matplotlib.image.imread(folder / name).std() > 0.05
    assert "smooth lights (A, B, C)" in result.stdout
    assert "spiky lights (FL2, FL7, FL11)" in result.stdout
    assert "FW7" in result.stdout
    assert "PS4" not in result.stdout  # beaten by others of four floats
    assert result.stderr.startswith("out: compare-boxes.png")


def test_target_prints_the_cheapest_for_each_set_of_lights(run, macbeth):
    words = f"lab compare --quick --atlas {macbeth} --tolerance"
    near = run(f"{words} 1.0 --filters").stdout.splitlines()
    assert [line.split(" lights")[0] for line in near] == ["smooth", "spiky"]
    assert all(
        float(re.search(r"97\.5 % below ([\d.]+)", line)[1]) <= 1 for line in near
    )
    (far,) = run(f"{words} 0.001", *GIVEN).stdout.splitlines()
    assert far.startswith("given lights (LED-B3, HP1): none; ")


def test_lights_replace_the_default_sets(run, macbeth):
    words = ["lab", "compare", "--quick", "--atlas", macbeth, *GIVEN, "--format"]
    fields = json.loads(run(*words, "json").stdout)
    rows = list(csv.DictReader(run(*words, "csv").stdout.splitlines()))
    names = {
        row["representation"]
        for row in fields["representations"]
        if row["lights"] == "given"
    }
    assert {row["representation"] for row in rows} == names
    assert len(rows) == len(fields["representations"]) == 50
    assert fields["facts"]["products"] == "24 surfaces under each light"
    assert fields["filters"] == []


def test_written_spectra_are_an_atlas_and_lamps(run, misuse, home, macbeth):
    words = f"lab compare --atlas {macbeth} --light FL11 --light A --write RS16"
    assert run(f"{words} -o out").stdout == "out: 24 surfaces and 2 lights as RS16\n"
    assert read_atlas("out/surfaces.csv").names == read_atlas(macbeth).names
    assert read_lamps("out/lights.csv").names == ("FL11", "A")
    misuse(words)
    misuse(f"{words} -o out --filters")
