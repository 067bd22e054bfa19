"""The page of paints: its numbers, and in Chromium mixtures and recipes."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.browsing import WIDTHS, check_page, open_page, overflow, shared_tab
from tests.extras.paint.invented import invented
from tests.helpers import output_of
from tests.parts import NODE, need
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.extras.colour.srgb import decode, hex_codes
from uplift.extras.paint.paint_page import page
from uplift.extras.paint.recipes import PaintTarget, match

PAINTS = invented(np.arange(400.0, 701, 10))
SENSOR = PAINTS.sensor
DIFFERENCES = """
import { readFileSync } from "node:fs";
const code = process.argv.slice(2).map(path => readFileSync(path, "utf8")).join("");
const deltaE = new Function(`${code}; return deltaE;`)();
const pairs = JSON.parse(readFileSync(0, "utf8"));
const errors = pairs.map(row => deltaE(row.slice(0, 3), row.slice(3, 6)));
console.log(JSON.stringify(errors));
"""


@pytest.fixture
def opened(tmp_path):
    """A tab that shows the page of all paints on a desk."""
    tab = shared_tab()
    open_page(tab, page(PAINTS), tmp_path)
    return tab


def code_of(reflectance):
    return hex_codes(SENSOR.rgb(reflectance[None]))[0]


def text(tab, name):
    return tab.evaluate(f"document.getElementById('{name}').textContent")


def put(tab, name, value, event="input"):
    """Set a control as its reader does."""
    control = f"document.getElementById('{name}')"
    tab.evaluate(
        f"{control}.value = {json.dumps(str(value))};"
        f"{control}.dispatchEvent(new Event('{event}')); 0"
    )


def recipes(tab):
    """Parts (n, P) and the stated ΔE00 (n,) of recipes."""
    items = tab.evaluate(
        "[...document.querySelectorAll('#recipes button')].map(item => "
        "[...item.querySelectorAll('span')].map(span => span.textContent))"
    )
    parts = np.zeros((len(items), len(PAINTS)))
    for row, (recipe, _) in enumerate(items):
        for part in recipe.split(" + "):
            amount, name = part.split(" ", 1)
            parts[row, PAINTS.index(name)] = int(amount)
    return parts, np.array([float(error.removeprefix("ΔE ")) for _, error in items])


def test_the_page_is_complete_narrow_and_accessible(tmp_path):
    check_page(page(PAINTS), tmp_path)


def test_mixtures_have_the_colours_of_python(opened):
    assert text(opened, "code") == code_of(PAINTS.reflectance([4, 2, 1, 0]))
    assert text(opened, "recipe") == "4 white + 2 yellow + 1 red"
    for paint, parts in enumerate([0, 6, 0, 2]):
        put(opened, f"parts-{paint}", parts)
    assert text(opened, "code") == code_of(PAINTS.reflectance([0, 6, 0, 2]))
    opened.evaluate("document.getElementById('clear').click(); 0")
    assert text(opened, "recipe") == "1 white"
    assert opened.errors == []


def test_films_hide_their_ground_from_thin_to_thick(opened):
    read = "document.getElementById('on-black').style.background"
    put(opened, "thickness", -3)
    assert max(map(int, re.findall(r"\d+", opened.evaluate(read))[:3])) < 100
    put(opened, "thickness", 3)
    assert min(map(int, re.findall(r"\d+", opened.evaluate(read))[:3])) > 30


@pytest.mark.parametrize("parts", [[3, 0, 0, 1], [4, 2, 1, 0]])
def test_recipes_are_as_good_as_those_of_python(opened, parts):
    reflectance = PAINTS.reflectance(parts)
    code = code_of(reflectance)
    put(opened, "target", code)
    found, errors = recipes(opened)
    assert (np.diff(errors) >= 0).all()
    target = PaintTarget(reflectance, (PAINTS.light("D65"),))
    assert errors[0] < match(target, PAINTS, steps=40)[0].error + 1
    wanted = decode(np.array(list(bytes.fromhex(code[1:]))) / 255)
    mixed = PAINTS.reflectance(found)
    assert_allclose(errors, delta_e_rgb(SENSOR, SENSOR.rgb(mixed), wanted), atol=0.02)
    opened.evaluate("document.querySelector('#recipes button').click(); 0")
    assert text(opened, "code") == code_of(mixed[0])


def test_colours_out_of_reach_are_stated(opened):
    put(opened, "target", "#00ff00")
    put(opened, "count", 1, "change")
    parts, errors = recipes(opened)
    assert ((parts > 0).sum(axis=1) == 1).all()
    assert errors[0] > 5
    assert f"{errors[0]:.1f}" in text(opened, "reach")


def test_one_paint_and_names_of_markup(tmp_path):
    name = '<b>&"</script><script>throw 1</script>' + "very long " * 15
    odd = replace(PAINTS.select(["blue"]), names=(name.strip(),))
    tab = shared_tab()
    open_page(tab, page(odd), tmp_path, WIDTHS[0])
    assert overflow(tab) <= 0
    assert tab.errors == []
    assert text(tab, "recipe") == f"1 {name.strip()}"


def test_differences_in_javascript_are_ciede2000(repository, tmp_path):
    """By the published pairs."""
    need(NODE)
    reference = repository / "tests" / "reference" / "ciede2000_sharma2005.csv"
    pairs = np.loadtxt(reference, delimiter=",", comments=("#", "L1"))
    (tmp_path / "differences.mjs").write_text(DIFFERENCES)
    extras = repository / "uplift" / "extras"
    answer = output_of(
        "node",
        tmp_path / "differences.mjs",
        extras / "pages" / "lab.js",
        extras / "paint" / "colour_difference.js",
        input=json.dumps(pairs.tolist()),
    )
    assert_allclose(json.loads(answer), pairs[:, 6], atol=5.1e-5)
