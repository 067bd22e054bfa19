"""Fixtures: a page of a colour of the ColorChecker cube, and a browser that shows pages."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.browser import browser
from tests.parts import CHROMIUM, need
from uplift.colorimetry import observer
from uplift.lookup import bounds
from uplift.report.look_page import page

LIGHTS = ("A", "FL11")


@pytest.fixture(scope="package")
def red():
    """Linear sRGB of #8a2a20."""
    return observer.sensor().decode([0x8A, 0x2A, 0x20])[None]


@pytest.fixture(scope="package")
def found(small_cube, red):
    return [bounds(small_cube, red, observer.light(name)) for name in LIGHTS]


@pytest.fixture(scope="package")
def html(small_cube, found):
    return page(small_cube, found)


@pytest.fixture(scope="package")
def tab():
    need(CHROMIUM)
    with browser() as opened:
        opened.window(1440, 900)
        yield opened


@pytest.fixture
def opened(tab, html, tmp_path):
    """The page of the red, freshly loaded."""
    (tmp_path / "page.html").write_text(html, encoding="utf-8")
    tab.open(tmp_path / "page.html")
    return tab


@pytest.fixture
def grey(small_cube):
    return [bounds(small_cube, np.full((1, 3), 0.31), observer.light("FL11"), divisions=1)]
