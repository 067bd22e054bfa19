"""Look page: its numbers; in Chromium a drag changes the spectrum, the RGB stays, and
colours are those of Python.
"""

import json
import tomllib

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.browser import SETTLE
from tests.browsing import check_page, shared_tab
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.gamut import SRGB
from uplift.common.errors import OptionError
from uplift.extras.colour.srgb import hex_codes, to_display_codes
from uplift.extras.looks.metamer_bounds import bounds
from uplift.extras.report.look_page import page

LIGHTS = ("A", "FL11")


@pytest.fixture(scope="module")
def red():
    """Linear sRGB of #8a2a20."""
    return observer.sensor().decode([0x8A, 0x2A, 0x20])[None]


@pytest.fixture(scope="module")
def found(small_cube, red):
    return [bounds(small_cube, red, observer.light(name)) for name in LIGHTS]


@pytest.fixture(scope="module")
def html(small_cube, found):
    return page(small_cube, found)


@pytest.fixture
def tab():
    tab = shared_tab()
    tab.window(1440, 900)
    return tab


@pytest.fixture
def opened(tab, html, tmp_path):
    """The page of the red, freshly loaded."""
    (tmp_path / "page.html").write_text(html, encoding="utf-8")
    tab.open(tmp_path / "page.html")
    return tab


def test_a_page_is_about_one_colour(small_cube):
    two = [bounds(small_cube, np.full((2, 3), 0.4), observer.light("A"), divisions=0)]
    for found in (two, []):
        with raises(OptionError, "option"):
            page(small_cube, found)


def drag(tab, light, dx, dy):
    """Drag the point of a light by a part of the width of its plot."""
    script = (
        "(box => [box.x + box.width / 2, box.y + box.height / "
        f"2])({rect(f'point-{light}')})"
    )
    x, y = tab.evaluate(script)
    width = tab.evaluate(f"{rect(f'region-{light}')}.width")
    tab.mouse("mousePressed", x, y)
    for share in (0.3, 0.7, 1):
        tab.mouse("mouseMoved", x + share * dx * width, y + share * dy * width)
    tab.mouse("mouseReleased", x + dx * width, y + dy * width)
    tab.evaluate(SETTLE)


def rect(element):
    return f"document.getElementById('{element}').getBoundingClientRect()"


def text(tab, element):
    return tab.evaluate(f"document.getElementById('{element}').textContent")


def spectrum(tab):
    return np.array(
        json.loads(
            tab.evaluate("document.getElementById('spectrum').dataset.reflectance")
        )
    )


def shown_lab(tab, light):
    words = text(tab, f"lab-{light}").replace("−", "-").replace(",", "").split()
    return [float(word) for word in words[1::2]]


def expected(spectra):
    """Codes of a spectrum under the build light and under the lights."""
    sensors = [observer.sensor("sRGB", name) for name in ("D65", *LIGHTS)]
    rgb = np.array([sensor.rgb(spectra) for sensor in sensors])
    return hex_codes(rgb, SRGB)


def test_the_page_opens_with_the_answer_and_a_drag_changes_the_spectrum_but_not_the_rgb(
    opened, red, sensor, found
):
    before = spectrum(opened)
    assert_allclose(before, found[0].reflectance[0], atol=1e-9)
    assert text(opened, "state-1") == "free"
    drag(opened, 1, -0.12, -0.04)
    after = spectrum(opened)
    assert np.abs(after - before).max() > 0.05
    assert ((after > 0) & (after < 1)).all()
    assert_allclose(sensor.rgb(after), red[0], atol=1e-5)
    codes = to_display_codes(sensor.rgb(np.stack([before, after])), SRGB)
    assert np.abs(codes[1] - codes[0]).max() <= 1
    assert text(opened, "state-1") == "chosen"
    assert text(opened, "state-0") == "free"


def test_colours_equal_those_of_python_and_goals_of_two_lights_hold_together(opened):
    drag(opened, 0, 0.08, 0.0)
    first = shown_lab(opened, 0)
    drag(opened, 1, -0.1, -0.03)
    current = spectrum(opened)
    assert shown_lab(opened, 0)[1:] == pytest.approx(first[1:], abs=0.5)
    shown = [text(opened, f"code-{name}").split(",")[0] for name in ("build", 0, 1)]
    assert shown == expected(current)
    for number, name in enumerate(LIGHTS):
        light = observer.light(name)
        assert shown_lab(opened, number) == pytest.approx(
            lab(light.xyz @ current, light.white), abs=0.051
        )
    (look,) = tomllib.loads(opened.evaluate("document.getElementById('toml').value"))[
        "look"
    ]
    assert look == {"rgb": "#8a2a20", **dict(zip(LIGHTS, shown[1:], strict=True))}
    opened.evaluate("document.getElementById('release-0').click()")
    opened.evaluate(SETTLE)
    assert (text(opened, "state-0"), text(opened, "state-1")) == ("free", "chosen")
    assert opened.errors == []


def test_keys_move_and_release_a_colour(opened, found):
    opened.evaluate("document.getElementById('region-1').focus()")
    start = shown_lab(opened, 1)
    opened.key("ArrowRight")
    opened.key("ArrowUp", modifiers=8)  # Shift
    opened.evaluate(SETTLE)
    assert shown_lab(opened, 1)[1:] == pytest.approx(
        [start[1] + 0.5, start[2] + 5], abs=0.11
    )
    value = opened.evaluate(
        "document.getElementById('region-1').getAttribute('aria-valuetext')"
    )
    assert value == f"{text(opened, 'lab-1')}, chosen"
    opened.key("0")
    opened.evaluate(SETTLE)
    assert_allclose(spectrum(opened), found[0].reflectance[0], atol=1e-9)


def test_the_page_fits_and_is_accessible(html, tmp_path):
    check_page(html, tmp_path)
