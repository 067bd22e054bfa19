"""Picture and page: all measured methods, escaped names, no external files."""

from __future__ import annotations

import json
import re

import matplotlib.image
import pytest

from tests.browsing import check_page
from tests.pages import Page, external_links
from uplift.lab.chart.page import render_chart
from uplift.lab.chart.panels import PANELS
from uplift.lab.chart.picture import _drawn, write_pictures
from uplift.lab.chart.table import State

HOSTILE = "</script><b>x</b>"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("chart")


def test_measured_methods_have_a_marker_in_every_panel(row_of, chart_of, folder):
    numbers = {key: value for key, value in row_of("one", 1, 1).numbers.items() if key != "batch_ns"}
    chart = chart_of(
        row_of("Mallett 2019", 80, 0.4),
        row_of("alone", 1e6, 0.1, numbers=numbers | {"time_ns": 1e6}),
        row_of("9 · 32³", 900, 0.02, build="uplift build", mode="refined", family="of another version"),
        row_of("wrong", 1, 1e-9, state=State.BROKEN),
    )
    write_pictures(chart, folder / "chart.png", folder / "chart.svg")
    text = (folder / "chart.svg").read_text(encoding="utf-8")
    assert matplotlib.image.imread(folder / "chart.png").shape[:2] == (2150, 1320)
    markers = re.findall(r'id="marker-(\d+)-(\d+)"', text)
    assert sorted(markers) == sorted((str(panel), row) for panel in range(len(PANELS)) for row in "012")
    assert text.count('id="whisker-') == 2 * 3
    assert "Mallett 2019" in text
    assert "wrong" not in text


def test_page_has_every_panel_fits_and_is_accessible(row_of, chart_of, tmp_path):
    text = render_chart(chart_of(row_of("one", 80, 0.4), row_of("two", 800, 0.2)))
    markers = re.findall(r'id="marker-(\d+)-(\d+)"', text)
    assert sorted(markers) == sorted((str(panel), row) for panel in range(len(PANELS)) for row in "01")
    check_page(text, tmp_path)


def test_cubes_that_others_of_their_kind_beat_are_not_drawn(row_of, chart_of):
    cubes = [
        row_of(f"cube {row}", time, error, build="uplift build", mode="moments")
        for row, (time, error) in enumerate([(10, 1.0), (20, 2.0), (30, 0.5)])
    ]
    others = [row_of(name, time, 3.0) for name, time in (("fast", 10), ("slow", 40))]
    drawn = [result.method for _, result in _drawn(PANELS[0], chart_of(*cubes, *others))]
    assert drawn == ["cube 0", "cube 2", "fast", "slow"]


def test_a_panel_without_a_front_is_empty(row_of, chart_of, tmp_path):
    """The tables of the only method come from elsewhere, so nothing is drawn over the time to build."""
    numbers = {key: value for key, value in row_of("one", 1, 1).numbers.items() if key != "build_s"}
    chart = chart_of(row_of("one", 80, 0.4, numbers=numbers))
    write_pictures(chart, tmp_path / "chart.png", tmp_path / "chart.svg")
    assert f'id="marker-{len(PANELS) - 1}-' not in (tmp_path / "chart.svg").read_text(encoding="utf-8")
    assert render_chart(chart)


def test_page_is_self_contained_and_escapes_names(row_of, chart_of):
    rows = row_of(HOSTILE, 80, 0.4), row_of("wrong", 1, 1, state=State.BROKEN, why=HOSTILE, numbers={})
    text = render_chart(chart_of(*rows))
    assert HOSTILE not in text
    assert not re.search(r'(?:src|href|url)\s*[=(]\s*["\']?(?:https?:)?//', text)
    assert external_links(text) == []
    assert HOSTILE in Page(text).text
    (data,) = re.findall(r'<script type="application/json" id="rows">(.*?)</script>', text, re.DOTALL)
    first, second = json.loads(data)
    assert first["title"] == HOSTILE
    assert ["memory", "10 kB"] in first["lines"]
    assert second["lines"] == []


def test_same_chart_gives_the_same_page(row_of, chart_of):
    chart = chart_of(row_of("one", 80, 0.4))
    assert render_chart(chart) == render_chart(chart)
