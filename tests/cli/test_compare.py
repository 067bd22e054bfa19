"""``uplift lab compare``."""

import json
import os
import re
from functools import cache

import pytest
from uplift_cli.commands import compare

from uplift.atlas.sources import read_atlas
from uplift.extras.emission.lamps import read_lamps
from uplift.extras.papers.representations import compare as representations
from uplift.extras.timing import ONE_THREAD

measure = cache(compare._measure)
GIVEN = ("--light", "LED-B3", "--light", "HP1")


@pytest.fixture(autouse=True)
def once(monkeypatch):
    """Restore the environment that the command changes, repeat no measurement, and take
    short timings.
    """
    monkeypatch.setattr(compare, "_measure", measure)
    monkeypatch.setattr(representations, "QUICK_TIMING", (16, 1e-4, 2))
    for name, value in ONE_THREAD.items():
        monkeypatch.setenv(name, value)


def test_all_files_are_written_and_tables_printed(run, home, macbeth):
    words = f"lab compare --quick --atlas {macbeth}"
    run(f"{words} -o out", *GIVEN)
    names = {"compare-boxes.png", "compare-cost.png", "compare.html"}
    assert set(os.listdir(home / "out")) == names
    shown = run(f"{words} --filters").stdout
    assert "spiky lights (FL2, FL7, FL11)" in shown
    assert "FW7" in shown
    assert "PS4" not in shown  # beaten by others of four floats


def test_target_prints_the_cheapest_for_each_set_of_lights(run, macbeth):
    words = f"lab compare --quick --atlas {macbeth} --tolerance"
    near = run(f"{words} 1.0 --filters").stdout
    largest = [float(text) for text in re.findall(r"97\.5 % below ([\d.]+)", near)]
    assert len(largest) == 2
    assert max(largest) <= 1
    (far,) = run(f"{words} 0.001", *GIVEN).stdout.splitlines()
    assert far.startswith("given lights (LED-B3, HP1): none; ")


def test_lights_replace_the_default_sets(run, macbeth):
    words = ["lab", "compare", "--quick", "--atlas", macbeth, *GIVEN, "--format"]
    fields = json.loads(run(*words, "json").stdout)
    assert {row["lights"] for row in fields["representations"]} == {"given"}
    rows = run(*words, "csv").stdout.splitlines()[1:]
    assert len(rows) == len(fields["representations"]) == 50


def test_written_spectra_are_an_atlas_and_lamps(run, home, macbeth):
    words = f"lab compare --atlas {macbeth} --light FL11 --light A --write RS16"
    run(f"{words} -o out")
    assert read_atlas("out/surfaces.csv").names == read_atlas(macbeth).names
    assert read_lamps("out/lights.csv").names == ("FL11", "A")
