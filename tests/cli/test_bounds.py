"""``uplift bounds``, up to a cube that answers a choice on its page."""

import csv
import io
import tomllib

import matplotlib.image
import numpy as np
import pytest

from benchmarks.browser import SETTLE, SHIFT, browser
from tests.parts import CHROMIUM, need
from uplift.colorimetry.delta_e import delta_e_rgb, lab
from uplift.colorimetry.observer import DEFAULT_OBSERVER, display_sensors, light
from uplift.colorimetry.srgb import decode

COLOURS = "0.2,0.3,0.4\n0.9,0.1,0.1"
LIGHTS = ("--light", "A", "--light", "FL11")
CHOICE = (("region-1", "ArrowLeft", 3), ("region-1", "ArrowDown", 1), ("region-0", "ArrowRight", 1))
"""Region, key and number of steps of 5 in a* or b*."""


def test_bounds_of_a_colour_in_json(ask):
    found = ask("bounds", "#8a2a20", *LIGHTS)
    assert list(found["bounds"]) == ["A", "FL11"]
    for name, each in found["bounds"].items():
        (least, most), answer = np.array(each["lab_range"]), np.array(each["lab"])
        assert ((least < answer) & (answer < most)).all()
        lit = light(name)
        np.testing.assert_allclose(answer, lab(lit.xyz @ found["reflectance"], lit.white), atol=1e-9)
        assert 0 < each["largest_delta_e_2000"] <= each["outer_delta_e_2000"]
        assert each["likely"] is None  # the packaged cube has no atlas
    assert found["bounds"]["FL11"]["share"] > 10 * found["bounds"]["A"]["share"]


def test_the_likely_difference_is_the_error_bound_in_all_formats(run, ask, cubes):
    colour = ("bounds", "--cube", cubes / "moments-16-macbeth.uplift", "0.2", "0.3", "0.1", "--light", "FL11")
    found = ask(*colour)
    bound = found["error_bounds"]["FL11"]
    assert bound > found["standard_errors"]["FL11"]
    assert float(run(*colour).stdout.splitlines()[-1].split()[4]) == pytest.approx(bound, abs=0.005)
    (row,) = csv.DictReader(io.StringIO(run(*colour, "--format", "csv").stdout))
    assert float(row["error_bound"]) == pytest.approx(bound)


def test_table_and_plot(run, home):
    text = run("bounds", "0.2,0.3,0.4", "--light", "D65", "--plot", "bounds.png").stdout
    row = text.splitlines()[-1].split()
    assert (row[0], float(row[5])) == ("D65", 0)  # metamers match under the build light
    assert max(map(len, text.splitlines())) <= 80
    assert matplotlib.image.imread(home / "bounds.png").shape[2] == 4


def test_bad_input_is_refused(refuse, misuse, home):
    assert refuse("bounds", "--xyz", "1", "0.1", "0.02").code == "colour-unrealisable"
    assert "one colour" in misuse("bounds", "-", "--html", "p.html", input=COLOURS)
    (home / "look.html").write_text("mine")
    assert refuse("bounds", "#8a2a20", "--html", "look.html").code == "file-exists"


def choose(page):
    """Move colours on the page and copy the look, as text."""
    with browser() as tab:
        tab.window(1440, 900)
        tab.open(page)
        for region, key, times in CHOICE:
            tab.evaluate(f"document.getElementById('{region}').focus()")
            for _ in range(times):
                tab.key(key, SHIFT)
                tab.evaluate(SETTLE)
        states = [tab.evaluate(f"document.getElementById('state-{number}').textContent") for number in (0, 1)]
        tab.evaluate("document.getElementById('copy').click()")
        field = "document.getElementById('toml')"
        copied = tab.evaluate(f"{field}.value.slice({field}.selectionStart, {field}.selectionEnd)")
    assert states == ["chosen", "chosen"]
    return copied


def test_a_cube_answers_a_choice_on_the_page(run, ask, home):
    run("bounds", "#8a2a20", *LIGHTS, "--html", "page.html")
    assert "Looks of #8a2a20" in (home / "page.html").read_text()
    need(CHROMIUM)
    (home / "looks.toml").write_text(choose(home / "page.html"), encoding="utf-8")
    (look,) = tomllib.loads((home / "looks.toml").read_text(encoding="utf-8"))["look"]
    run("build", "--dim", 4, "--look", "looks.toml", "-o", "looks.uplift")
    before, after = (ask("query", look["rgb"], *LIGHTS, *cube) for cube in ((), ("--cube", "looks.uplift")))
    assert after["round_trip"]["delta_e_2000"] < 1e-3
    for screen in display_sensors(("A", "FL11"), DEFAULT_OBSERVER):
        name = screen.illuminant
        chosen = decode(np.array(list(bytes.fromhex(look[name][1:]))) / 255)
        assert delta_e_rgb(screen, after["lights"][name]["srgb"], chosen) <= 0.1
        assert delta_e_rgb(screen, before["lights"][name]["srgb"], chosen) > 1
