"""Relit images as pictures and as a page, in Chromium too."""

import json

import numpy as np
import pytest

from benchmarks.browser import browser
from tests.browsing import check_page
from tests.pages import Page
from tests.parts import CHROMIUM, need
from uplift.extras.relight.relight import relight, relit_page


@pytest.fixture(scope="module")
def relit(small_cube, plain_cube):
    rgb = np.random.default_rng(5).uniform(0, 1, (24, 40, 3)).astype(np.float32)
    cubes = {"without <atlas>": plain_cube, "atlas": small_cube}
    return relight("a & b.png", rgb, cubes, ("D65", "A", "HP1"), reduction=3)


@pytest.fixture(scope="module")
def page(relit, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "relit.html"
    path.write_text(relit_page([relit, relit]), encoding="utf-8")
    return path


def test_the_page_is_well_formed_and_holds_its_images(page):
    found = Page(page.read_text("utf-8"))
    sources = [value for name, value in found.attributes if name == "src"]
    # Images, original, lights, methods twice and pairs of them.
    assert len(sources) == 2 * (1 + 3 * (2 * 3 + 3))
    assert all(text for name, text in found.attributes if name == "alt")
    assert "a & b.png" in found.text
    assert "without <atlas>" in found.text


def test_the_page_fits_and_is_accessible(relit, tmp_path):
    check_page(relit_page([relit]), tmp_path)


@pytest.fixture(scope="module")
def tab(page):
    need(CHROMIUM)
    with browser() as opened:
        opened.open(page)
        yield opened


VISIBLE = """[...document.querySelector(".view").querySelectorAll("img")]
  .filter(image => getComputedStyle(image).display !== "none")
  .map(image => [image.dataset.light, image.dataset.shows])"""
SPLIT = 'getComputedStyle(document.querySelector(".view")).getPropertyValue("--split")'
CHOOSE = """((light, left, right, asMap) => {
  const form = document.querySelector(".choices");
  form.elements.light.value = light;
  first.value = left; second.value = right; map.checked = asMap;
  form.dispatchEvent(new Event("change"));
})"""


def choose(tab, *choices):
    tab.evaluate(f"{CHOOSE}(...{json.dumps(choices)})")


def test_the_page_opens_where_the_difference_is_largest_and_choices_change_the_layers(
    tab,
):
    assert tab.evaluate(VISIBLE) == [["2", "0"], ["2", "2"]]
    for choices, layers in (
        ((1, 2, 1, False), [["1", "1"], ["1", "2"]]),
        ((1, 2, 0, True), [["1", "0-2"]]),
        ((1, 1, 1, True), [["1", "1"]]),
        ((1, 3, 2, True), [["", "3"], ["1", "2"]]),  # the original has no map
    ):
        choose(tab, *choices)
        assert sorted(tab.evaluate(VISIBLE)) == layers
    assert tab.errors == []


def test_the_line_moves_by_key(tab):
    tab.window(1200, 900)
    tab.evaluate(
        'document.querySelector(".split").value = 50; '
        'document.querySelector(".split").focus()'
    )
    tab.key("ArrowRight")
    assert tab.evaluate(SPLIT) == "51%"
