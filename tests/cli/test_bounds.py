"""``uplift lab bounds``."""

import csv
import io

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.observer import light

COLOURS = "0.2,0.3,0.4\n0.9,0.1,0.1"
LIGHTS = ("--light", "A", "--light", "FL11")


def test_bounds_of_a_colour_in_json(ask):
    found = ask("lab bounds #8a2a20", *LIGHTS)
    for name, each in found["bounds"].items():
        lit = light(name)
        answer = lab(lit.xyz @ found["reflectance"], lit.white)
        assert_allclose(each["lab"], answer, atol=1e-9)
        least, most = np.array(each["lab_range"])
        assert ((least < answer) & (answer < most)).all()
        assert 0 < each["largest_delta_e_2000"] <= each["outer_delta_e_2000"]


def test_the_likely_difference_is_the_error_bound_in_all_formats(run, ask, cubes):
    words = "lab bounds 0.2 0.3 0.1 --light FL11 --cube"
    cube = cubes / "moments-16-macbeth.uplift"
    bound = ask(words, cube)["error_bounds"]["FL11"]
    assert f" {bound:.2f} " in run(words, cube).stdout.splitlines()[-1]
    rows = csv.DictReader(io.StringIO(run(words, cube, "--format", "csv").stdout))
    assert float(next(rows)["error_bound"]) == pytest.approx(bound)


@pytest.mark.parametrize("cube", ["srgb", "acescg"])
def test_expected_errors_are_possible(ask, cube):
    """Few reflectances have the colours of the ends of the space."""
    colours = "#000000 #ffffff #00ffff #ffff00 #ff00ff #fefefe #010203 #f0ffff #888888"
    words = f"--cube {cube} --input-space sRGB --out-of-gamut clip"
    found = ask("lab bounds", *colours.split(), *words.split(), *LIGHTS)
    queried = ask("query", *colours.split(), *words.split(), *LIGHTS)
    for answer, query in zip(found, queried, strict=True):
        for name, bounds in answer["bounds"].items():
            largest = bounds["largest_delta_e_2000"] + 1e-9
            assert answer["error_bounds"][name] <= largest
            assert query["standard_errors"][name] <= query["error_bounds"][name]
            assert query["error_bounds"][name] <= largest
    assert found[-1]["error_bounds"]["A"] > 1


def test_table_plot_and_page(run, home):
    # A light counts once.
    words = "--light D65 --light d65 --plot bounds.png --html page.html"
    text = run(f"lab bounds 0.2,0.3,0.4 {words}").stdout
    row = text.splitlines()[-1].split()
    assert (row[0], float(row[5])) == ("D65", 0)  # metamers match under the build light
    assert (home / "bounds.png").read_bytes().startswith(b"\x89PNG")
    assert "Looks of " in (home / "page.html").read_text("utf-8")


def test_a_further_colour_cuts_the_bounds(run, ask, cubes):
    colour = f"lab bounds #8a2a20 --cube {cubes}/moments-16-macbeth.uplift --light FL11"
    found = ask(f"{colour} --also A:#9a3020")
    assert found["bounds"] == ask(colour)["bounds"]
    whole = found["bounds"]["FL11"]
    cut = found["also_bounds"]["FL11"]
    assert cut["share"] < 0.1 * whole["share"]
    assert cut["largest_delta_e_2000"] < whole["largest_delta_e_2000"]
    assert cut["standard_error"] < found["standard_errors"]["FL11"]
    (least, most), (lowest, highest) = np.array([cut["lab_range"], whole["lab_range"]])
    assert (lowest < least).all()
    assert (most < highest).all()
    text = run(f"{colour} --also A:#9a3020 --plot cut.png").stdout
    *_, before, after = text.splitlines()
    assert before.split()[:2] == ["FL11", "D65"]
    assert after.split()[:2] == ["D65,", "A"]
