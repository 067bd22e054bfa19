"""Pages in Chromium as readers see them: on a phone in the light scheme, on a desk in
the dark one.

Widths change the layout and schemes the colours, never both: two states show what four
would.
"""

import atexit
import json
from contextlib import ExitStack
from functools import cache
from pathlib import Path

import pytest

from benchmarks.browser import browser
from tests.pages import external_links
from tests.parts import CHROMIUM, need

WIDTHS = (390, 1440)
HEIGHT = 900
SCHEMES = ("light", "dark")
AXE = Path(__file__).parents[1] / "out" / "axe" / "axe_playwright_python" / "axe.min.js"
"""Rules of accessibility, axe-core, which `make axe` puts there."""
PLAIN_BOXES = ".scroll { background: none !important; }"
"""Contrast over gradients cannot be computed: without the cue of tables that scroll."""
RUN = """(() => {
  const style = document.createElement("style");
  document.head.append(Object.assign(style, { textContent: STYLE }));
  const shown = nodes => nodes.map(node => node.html.slice(0, 200)).join(" | ");
  return axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) =>
    violations.map(({ id, nodes }) => `${id}: ${shown(nodes)}`));
})()"""


def open_page(tab, html, folder, width=WIDTHS[1], scheme=SCHEMES[0]):
    """Show a page in a window of a size and wait until it is ready."""
    path = folder / "page.html"
    path.write_text(html, encoding="utf-8")
    tab.window(width, HEIGHT, scheme)
    tab.open(path)


def overflow(tab):
    """Pixels by which the page is wider than its window."""
    return tab.evaluate("document.documentElement.scrollWidth - window.innerWidth")


def findings(tab):
    """Violations of the rules of accessibility."""
    tab.evaluate(AXE.read_text("utf-8") + ";0")
    return tab.evaluate(RUN.replace("STYLE", json.dumps(PLAIN_BOXES)))


@cache
def shared_tab():
    """Return the tab of the browser that checks all pages of this process."""
    need(CHROMIUM)
    stack = ExitStack()
    atexit.register(stack.close)
    return stack.enter_context(browser())


def check_page(html, folder):
    """Fail if a page loads a file, is too wide, has errors or violates rules; skip what
    the machine lacks.
    """
    assert all(link.startswith("data:image/") for link in external_links(html))
    assert "@import" not in html
    tab = shared_tab()
    for width, scheme in zip(WIDTHS, SCHEMES, strict=True):
        open_page(tab, html, folder, width, scheme)
        assert overflow(tab) <= 0
        assert tab.errors == []
        if AXE.exists():
            assert findings(tab) == []
    if not AXE.exists():
        pytest.skip(f"no axe-core at {AXE}: run make axe")
