"""Pages in Chromium: width, accessibility, schemes of colour; their own script works,
no other one runs.
"""

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


def test_shared_parts_fit_and_are_accessible(tmp_path):
    figure = draw([Panel([line([0, 1], [0, 1], colour="#20509a")])])
    page = environment().from_string(WIDE_TABLE)
    text = page.render(
        title="A page",
        lead="x",
        headings=[f"a long heading {row}" for row in range(12)],
        chart=to_page_svg(figure, "A line"),
    )
    check_page(text, tmp_path)


INTERACTIVE = "extras/pages/templates/interactive.html.j2"
ATTACK = Markup(
    "<script>document.title = 'attacked'</script><b onclick='document.title = "
    '"attacked"\'>x</b>'
)
CIRCLE = (
    "<svg viewBox='0 0 9 9'><g id='marker-0-0'><circle r='3' cx='4' cy='4'/></g></svg>"
)


def interactive(lead):
    return render(
        INTERACTIVE,
        title="A page",
        lead=lead,
        pictures=[("A panel", Markup(CIRCLE))],
        tooltips=[{"title": "a point", "family": "one", "lines": [("", "1 ns")]}],
        families={"one": "#808080"},
        facts={},
        sources=[],
    )


HOVER = """(() => {
  const enter = new PointerEvent("pointerenter", { clientX: 1, clientY: 1 });
  document.getElementById("marker-0-0").dispatchEvent(enter);
  return document.getElementById("tip").textContent;
})()"""


def test_the_script_of_the_page_runs_and_others_do_not(tmp_path):
    tab = shared_tab()
    open_page(tab, interactive("x"), tmp_path)
    assert "a point" in tab.evaluate(HOVER)
    assert tab.errors == []
    open_page(tab, interactive(ATTACK), tmp_path)
    tab.evaluate("document.querySelector('.lead b').click()")
    assert tab.evaluate("document.title") == "A page"
    assert any("Content Security Policy" in error for error in tab.errors)
