"""``uplift bounds``."""

import csv
import io

import matplotlib.image
import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.colorimetry import lab
from uplift.colorimetry.observer import light

COLOURS = "0.2,0.3,0.4\n0.9,0.1,0.1"
LIGHTS = ("--light", "A", "--light", "FL11")


def test_bounds_of_a_colour_in_json(ask):
    found = ask("bounds #8a2a20", *LIGHTS)
    assert list(found["bounds"]) == ["A", "FL11"]
    for name, each in found["bounds"].items():
        least, most = np.array(each["lab_range"])
        answer = np.array(each["lab"])
        assert ((least < answer) & (answer < most)).all()
        lit = light(name)
        assert_allclose(
            answer, lab(lit.xyz @ found["reflectance"], lit.white), atol=1e-9
        )
        assert 0 < each["largest_delta_e_2000"] <= each["outer_delta_e_2000"]
        assert each["likely"] is None  # the packaged cube has no atlas
    assert found["bounds"]["FL11"]["share"] > 10 * found["bounds"]["A"]["share"]


def test_the_likely_difference_is_the_error_bound_in_all_formats(run, ask, cubes):
    colour = f"bounds --cube {cubes}/moments-16-macbeth.uplift 0.2 0.3 0.1 --light FL11"
    found = ask(colour)
    bound = found["error_bounds"]["FL11"]
    assert bound > found["standard_errors"]["FL11"]
    assert float(run(colour).stdout.splitlines()[-1].split()[4]) == pytest.approx(
        bound, abs=0.005
    )
    (row,) = csv.DictReader(io.StringIO(run(f"{colour} --format csv").stdout))
    assert float(row["error_bound"]) == pytest.approx(bound)


def test_table_plot_and_page(run, home):
    # A light counts once.
    words = "--light D65 --light d65 --plot bounds.png --html page.html"
    text = run(f"bounds 0.2,0.3,0.4 {words}").stdout
    row = text.splitlines()[-1].split()
    assert (row[0], float(row[5])) == ("D65", 0)  # metamers match under the build light
    assert max(map(len, text.splitlines())) <= 80
    assert matplotlib.image.imread(home / "bounds.png").shape[2] == 4
    assert "Looks of " in (home / "page.html").read_text("utf-8")


def test_bad_input_is_refused(refuse, misuse, home):
    assert refuse("bounds --xyz 1 0.1 0.02").code == "colour-unrealisable"
    assert "one colour" in misuse("bounds - --html p.html", input=COLOURS)
    (home / "look.html").write_text("mine")
    assert refuse("bounds #8a2a20 --html look.html").code == "file-exists"
