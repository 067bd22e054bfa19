"""The parts that pages share in Chromium: width, accessibility and the two schemes of colour."""

from __future__ import annotations

import pytest

from benchmarks.browser import browser
from tests.browsing import AXE, check_page, findings, open_page, overflow
from tests.parts import CHROMIUM, need
from uplift.viz.figure import new_figure, to_page_svg
from uplift.viz.html import Markup, _environment

WIDE_TABLE = """{% extends "viz/templates/base.html.j2" %}
{% import "viz/templates/macros.html.j2" as parts %}
{% block content %}
<h2>A table</h2>
{{ parts.simple_table(headings, [headings], numbers=[1, 2]) }}
{{ chart }}
{% endblock %}"""


def page(**values):
    figure = new_figure(4, 2)
    figure.subplots().plot([0, 1], color="#20509a")
    headings = [f"a long heading {row}" for row in range(12)]
    chart = to_page_svg(figure, "A line")
    template = _environment().from_string(WIDE_TABLE)
    return template.render(**{"title": "A page", "lead": "x", "headings": headings, "chart": chart} | values)


@pytest.fixture(scope="module")
def tab():
    need(CHROMIUM)
    with browser() as opened:
        yield opened


def test_shared_parts_fit_and_are_accessible(tmp_path):
    check_page(page(), tmp_path)


def test_wide_tables_scroll_by_keys(tab, tmp_path):
    open_page(tab, page(), tmp_path, width=390)
    tab.evaluate("document.querySelector('.scroll').focus()")
    assert tab.evaluate("document.activeElement.className") == "scroll"
    assert tab.evaluate("(box => box.scrollWidth > box.clientWidth)(document.querySelector('.scroll'))")


def test_grey_surround_replaces_the_dark_scheme(tab, tmp_path):
    background = "getComputedStyle(document.documentElement).backgroundColor"
    line = "getComputedStyle(document.querySelector('svg path[style*=accent]')).stroke"
    height = "document.getElementById('grey-surround').getBoundingClientRect().height"
    open_page(tab, page(), tmp_path, scheme="light")
    assert tab.evaluate(height) == 0
    light = tab.evaluate(background), tab.evaluate(line)
    open_page(tab, page(), tmp_path, scheme="dark")
    assert tab.evaluate(height) > 0
    dark = tab.evaluate(background), tab.evaluate(line)
    assert all(one != other for one, other in zip(light, dark, strict=True))
    tab.evaluate("document.getElementById('grey-surround').click()")
    assert (tab.evaluate(background), tab.evaluate(line)) == light


def test_the_checks_can_fail(tab, tmp_path):
    wide = Markup('<div style="width: 900px"><img src="data:,"></div>')
    open_page(tab, page(chart=wide), tmp_path, width=390)
    assert overflow(tab) > 0
    if AXE.exists():
        assert any("image-alt" in finding for finding in findings(tab))


def test_colours_of_the_dark_scheme_are_checked(tab, tmp_path):
    if not AXE.exists():
        pytest.skip("needs axe-core: run make axe")
    html = page(chart=Markup('<p style="color: #222">legible in the light scheme</p>'))
    open_page(tab, html, tmp_path, scheme="light")
    assert findings(tab) == []
    with pytest.raises(AssertionError):
        check_page(html, tmp_path)
