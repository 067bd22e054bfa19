"""The content security policy of pages in Chromium: their own script works, no other one runs."""

from __future__ import annotations

import time

import pytest

from benchmarks.browser import browser
from tests.parts import CHROMIUM, need
from uplift.viz.html import Markup, content_security_policy, render

INTERACTIVE = "viz/templates/interactive.html.j2"
ATTACK = Markup("<script>document.title = 'attacked'</script><b onclick='document.title = \"attacked\"'>x</b>")


@pytest.fixture(scope="module")
def tab():
    need(CHROMIUM)
    with browser() as opened:
        yield opened


@pytest.fixture
def opened(tab, tmp_path):
    """A function that shows a page."""

    def show(html):
        path = tmp_path / "page.html"
        path.write_text(html, encoding="utf-8")
        tab.errors.clear()
        tab.call("Page.navigate", url=path.as_uri())
        end = time.monotonic() + 30
        while not tab.evaluate("document.readyState === 'complete' && location.protocol === 'file:'"):
            assert time.monotonic() < end
        return tab

    return show


def interactive(**values):
    circle = "<svg viewBox='0 0 9 9'><g id='marker-0-0'><circle r='3' cx='4' cy='4'/></g></svg>"
    tooltips = [{"title": "a point", "family": "one", "lines": [("", "1 ns")]}]
    page = {"title": "A page", "lead": "x", "families": {"one": "#808080"}, "facts": {}, "sources": []}
    return render(INTERACTIVE, pictures=[("A panel", Markup(circle))], tooltips=tooltips, **page | values)


HOVER = """(() => {
  document.getElementById("marker-0-0").dispatchEvent(new PointerEvent("pointerenter", { clientX: 1, clientY: 1 }));
  return document.getElementById("tip").textContent;
})()"""


def test_script_of_the_page_runs(opened):
    tab = opened(interactive())
    assert "a point" in tab.evaluate(HOVER)
    assert tab.errors == []


def test_other_scripts_do_not_run(opened):
    tab = opened(interactive(lead=ATTACK))
    tab.evaluate("document.querySelector('.lead b').click()")
    assert tab.evaluate("document.title") == "A page"
    assert any("Content Security Policy" in error for error in tab.errors)


def test_page_without_a_script_runs_none(opened):
    tab = opened(render("viz/templates/base.html.j2", title="A page", lead=ATTACK))
    assert tab.evaluate("document.title") == "A page"


def test_without_the_policy_the_attack_succeeds(opened):
    html = render("viz/templates/base.html.j2", title="A page", lead=ATTACK)
    tab = opened(html.replace("Content-Security-Policy", "x"))
    assert tab.evaluate("document.title") == "attacked"


def test_policy_depends_on_the_script():
    assert content_security_policy("1") != content_security_policy("2")
    assert "script-src 'none'" in content_security_policy("")
