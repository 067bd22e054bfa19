"""Pages in Chromium: width, accessibility, schemes of colour; their own script works,
no other one runs.
"""

import pytest

from tests.browsing import check_page, open_page, shared_tab
from uplift.extras.pages.figure import to_page_svg
from uplift.extras.pages.html import Markup, environment, render
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Panel, draw

WIDE_TABLE = """{% extends "extras/pages/templates/base.html.j2" %}
{% import "extras/pages/templates/macros.html.j2" as parts %}
{% block content %}
<h2>A table</h2>
{{ parts.simple_table(headings, [headings], numbers=[1, 2]) }}
{{ chart }}
{% endblock %}"""


def page(**values):
    figure = draw([Panel([line([0, 1], [0, 1], colour="#20509a")])])
    headings = [f"a long heading {row}" for row in range(12)]
    chart = to_page_svg(figure, "A line")
    template = environment().from_string(WIDE_TABLE)
    return template.render(
        **{"title": "A page", "lead": "x", "headings": headings, "chart": chart}
        | values
    )


@pytest.fixture
def tab():
    return shared_tab()


def test_shared_parts_fit_and_are_accessible(tmp_path):
    check_page(page(), tmp_path)


def test_wide_tables_scroll_by_keys(tab, tmp_path):
    open_page(tab, page(), tmp_path, width=390)
    tab.evaluate("document.querySelector('.scroll').focus()")
    assert tab.evaluate("document.activeElement.className") == "scroll"
    assert tab.evaluate(
        "(box => box.scrollWidth > box.clientWidth)(document.querySelector('.scroll'))"
    )


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


INTERACTIVE = "extras/pages/templates/interactive.html.j2"
ATTACK = Markup(
    "<script>document.title = 'attacked'</script><b onclick='document.title = "
    '"attacked"\'>x</b>'
)


def interactive(**values):
    circle = (
        "<svg viewBox='0 0 9 9'><g id='marker-0-0'><circle r='3' cx='4' "
        "cy='4'/></g></svg>"
    )
    tooltips = [{"title": "a point", "family": "one", "lines": [("", "1 ns")]}]
    page = {
        "title": "A page",
        "lead": "x",
        "families": {"one": "#808080"},
        "facts": {},
        "sources": [],
    }
    return render(
        INTERACTIVE,
        pictures=[("A panel", Markup(circle))],
        tooltips=tooltips,
        **page | values,
    )


HOVER = """(() => {
  const enter = new PointerEvent("pointerenter", { clientX: 1, clientY: 1 });
  document.getElementById("marker-0-0").dispatchEvent(enter);
  return document.getElementById("tip").textContent;
})()"""


def test_the_script_of_the_page_runs_and_others_do_not(tab, tmp_path):
    open_page(tab, interactive(), tmp_path)
    assert "a point" in tab.evaluate(HOVER)
    assert tab.errors == []
    open_page(tab, interactive(lead=ATTACK), tmp_path)
    tab.evaluate("document.querySelector('.lead b').click()")
    assert tab.evaluate("document.title") == "A page"
    assert any("Content Security Policy" in error for error in tab.errors)
