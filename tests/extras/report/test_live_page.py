"""Live page: the picture in the browser agrees with Python."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.browser import browser
from tests.browsing import check_page
from tests.helpers import raises
from tests.parts import CHROMIUM, need
from uplift.colorimetry.observer import light
from uplift.common.errors import OptionError
from uplift.extras.colour.srgb import encode
from uplift.extras.report import live_page

SET = """(() => {
  for (const [id, value] of Object.entries(VALUES)) {
    const element = document.getElementById(id);
    if (element.type === "checkbox") element.checked = value;
    else element.value = value;
    element.dispatchEvent(new Event("change"));
    element.dispatchEvent(new Event("input"));
  }
})()"""


@pytest.fixture(scope="module")
def page(small_cube, tmp_path_factory):
    """Path of a page."""
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(live_page.page(small_cube.data), encoding="utf-8")
    return path


def test_the_page_fits_and_is_accessible(page, tmp_path):
    check_page(page.read_text("utf-8"), tmp_path)


def test_pixels_equal_those_of_python_under_a_mix_of_lights(page, small_cube):
    need(CHROMIUM)
    with browser() as opened:
        opened.open(page)
        states = [
            {"mix": 0, "split": 768, "balance": False},
            {"light-b": "FL11", "mix": 40, "split": 0},
        ]
        pictures = []
        for state in states:
            opened.evaluate(SET.replace("VALUES", str(state).replace("False", "false")))
            pictures.append(
                opened.canvas("view")[::37, 1::41, :3].reshape(-1, 3).astype(float)
            )
        curve = opened.evaluate("document.getElementById('curve').getAttribute('d')")
        assert opened.errors == []
    source, found = pictures
    sensor = small_cube.data.sensor
    rgb = small_cube.decode(source)
    weights = [
        sensor.xyz_to_rgb @ light(name, sensor.observer).xyz for name in ("D65", "FL11")
    ]
    linear = small_cube.reflectance(rgb) @ (0.6 * weights[0] + 0.4 * weights[1]).T
    expected = 255 * encode(np.clip(linear, 0, 1))
    assert_allclose(found, expected, atol=2)
    assert np.abs(found - source).max() > 10
    assert curve.startswith("M8.0")
    assert curve.count("L") == 83


def test_other_cubes_are_rejected(small_cube):
    sensor = replace(small_cube.data.sensor, space="Display P3")
    with raises(OptionError, "option"):
        live_page.page(replace(small_cube.data, sensor=sensor))
