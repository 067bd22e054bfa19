"""Fixtures: a relighting of random numbers, and a browser to show its page."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.browser import browser
from tests.parts import CHROMIUM, need
from uplift.design.palette.relight_viewer.page import page
from uplift.design.palette.relight_viewer.relighting import Lights, Materials, Relighting


def arbitrary(lights=3, materials=4, m=7, size=(40, 56), title="Arbitrary"):
    """Relighting with empty rows of pixels, and with colours inside and outside the display gamut."""
    draw = np.random.default_rng(lights + 10 * materials + 100 * m)
    weights = draw.dirichlet(np.full(materials, 0.3), size) * draw.uniform(0, 1, (*size, 1))
    weights[:5] = 0
    power = draw.uniform(0.2, 1.5, (lights, 21))
    return Relighting(
        title=title,
        weights=weights.astype(np.float32),
        materials=Materials(
            tuple(f"material {row}" for row in range(materials)),
            draw.uniform(0, 1, (materials, m)),
            draw.uniform(-0.05, 1.05, (materials, lights, 3)),
        ),
        lights=Lights(
            tuple(f"light {row}" for row in range(lights)),
            power,
            draw.uniform(0.3, 1.4, (lights, m)),
            draw.uniform(0.2, 1, (lights, 3)),
        ),
        to_rgb=draw.normal(1 / m, 0.15, (3, m)),
        wavelengths=np.linspace(400, 700, 21),
    )


@pytest.fixture(scope="package")
def view():
    return arbitrary()


@pytest.fixture(scope="package")
def tab():
    need(CHROMIUM)
    with browser() as opened:
        opened.window(1200, 1100)
        yield opened


@pytest.fixture
def opened(tab, tmp_path):
    """A function that shows a page in the browser."""

    def show(view):
        (tmp_path / "page.html").write_text(page(view), encoding="utf-8")
        tab.open(tmp_path / "page.html")
        return tab

    return show
