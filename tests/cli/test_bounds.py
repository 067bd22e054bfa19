"""``uplift bounds``."""

from __future__ import annotations

import csv
import io
import json

import matplotlib.image
import numpy as np
import pytest

import uplift
from uplift.lookup.light_errors import LIKELY

COLOURS = "0.2,0.3,0.4\n0.9,0.1,0.1"


@pytest.fixture
def ask(run):
    """Parsed JSON output."""
    return lambda *args: json.loads(run("bounds", *args, "--format", "json").stdout)


def test_bounds_of_a_colour_in_json(ask):
    found = ask("#8a2a20", "--light", "A", "--light", "FL11")
    assert list(found["bounds"]) == ["A", "FL11"]
    for name, each in found["bounds"].items():
        (least, most), answer = np.array(each["lab_range"]), np.array(each["lab"])
        assert ((least < answer) & (answer < most)).all()
        light = uplift.colorimetry.observer.light(name)
        lab = uplift.colorimetry.delta_e.lab(light.xyz @ found["reflectance"], light.white)
        np.testing.assert_allclose(answer, lab, atol=1e-9)
        assert 0 < each["largest_delta_e_2000"] <= each["outer_delta_e_2000"]
        assert len(each["outline"]) == 120
        assert (each["likely"], each["likely_share"]) == (None, LIKELY)  # the packaged cube has no atlas
    assert found["bounds"]["FL11"]["share"] > 10 * found["bounds"]["A"]["share"]


def test_the_likely_difference_is_the_error_bound(run, ask, cubes):
    """One share in all formats: that of the likely region."""
    colour = ("--cube", cubes / "moments-16-macbeth.uplift", "0.2", "0.3", "0.1", "--light", "FL11")
    found = ask(*colour)
    bound = found["error_bounds"]["FL11"]
    assert bound > found["standard_errors"]["FL11"]
    assert float(run("bounds", *colour).stdout.splitlines()[-1].split()[4]) == pytest.approx(bound, abs=0.005)
    (row,) = csv.DictReader(io.StringIO(run("bounds", *colour, "--format", "csv").stdout))
    assert float(row["error_bound"]) == pytest.approx(bound)


def test_bounds_of_many_colours(run):
    text = run("bounds", "-", "--format", "csv", input=COLOURS).stdout
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [row["light"] for row in rows] == 2 * ["A", "FL11", "HP1"]
    assert all(0 < float(row["largest"]) <= float(row["outer"]) for row in rows)
    assert all(float(row["a*_min"]) < float(row["a*"]) < float(row["a*_max"]) for row in rows)


def test_table_and_plot_of_bounds(run, home):
    text = run("bounds", "0.2,0.3,0.4", "--light", "D65", "--plot", "bounds.png").stdout
    heading, row = text.splitlines()[-2:]
    assert heading.split() == ["light", "L*", "a*", "b*", "likely", "95%", "largest", "a*", "b*", "share"]
    assert row.split()[0] == "D65"
    assert float(row.split()[5]) == 0  # metamers match under the build light
    assert max(map(len, text.splitlines())) <= 80
    assert matplotlib.image.imread(home / "bounds.png").shape[2] == 4


def test_bounds_of_an_unrealisable_colour(run):
    assert "no reflectance has the colour" in run("bounds", "--xyz", "1", "0.1", "0.02", code=2).stderr


def test_page_of_bounds(run, home):
    result = run("bounds", "#8a2a20", "--light", "FL11", "--html", "look.html")
    assert "FL11" in result.stdout
    assert "Looks of #8a2a20" in (home / "look.html").read_text()
    assert "exists already" in run("bounds", "#8a2a20", "--html", "look.html", code=2).stderr
    assert "one colour" in run("bounds", "-", "--html", "p.html", input=COLOURS, code=2).stderr
