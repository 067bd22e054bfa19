"""Picture and page: all measured methods, escaped names, no external files."""

from __future__ import annotations

import json
import re

import matplotlib.image
import pytest

from benchmarks.browser import browser
from tests.browsing import check_page, open_page
from tests.pages import Page, external_links
from tests.parts import CHROMIUM, need
from uplift.lab.chart.picture import SHOWN, drawn_results, render_chart, write_pictures
from uplift.lab.chart.table import State, all_panels, panels_of

HOSTILE = "</script><b>x</b>"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("chart")


def test_measured_methods_have_a_marker_in_every_panel(row_of, chart_of, folder):
    chart = chart_of(
        row_of("Mallett 2019", 80, 0.4),
        row_of("alone", 1e6, 0.1, numbers=row_of("one", 1e6, 0.1).numbers | {"ns_64_colours": 3}),
        row_of("9 · 32³", 900, 0.02, build="uplift build", mode="refined", family="of another version"),
        row_of("wrong", 1, 1e-9, state=State.BROKEN),
    )
    write_pictures(chart, folder / "chart.png", folder / "chart.svg")
    text = (folder / "chart.svg").read_text(encoding="utf-8")
    assert matplotlib.image.imread(folder / "chart.png").shape[:2] == (1200, 1680)
    markers = re.findall(r'id="marker-(\d+)-(\d+)"', text)
    drawn = range(SHOWN * len(chart.batches))
    assert sorted(markers) == sorted((str(panel), row) for panel in drawn for row in "012")
    assert text.count('id="whisker-') == 2 * 3 * len(chart.batches)
    assert "Mallett 2019" in text
    assert "wrong" not in text


def test_page_has_every_panel_fits_and_is_accessible(row_of, chart_of, tmp_path):
    chart = chart_of(row_of("one", 80, 0.4), row_of("two", 800, 0.2))
    text = render_chart(chart)
    markers = re.findall(r'id="marker-(\d+)-(\d+)"', text)
    assert sorted(markers) == sorted((str(number), row) for number in range(len(all_panels(chart))) for row in "01")
    check_page(text, tmp_path)


def test_cubes_that_others_of_their_kind_beat_are_not_drawn(row_of, chart_of):
    cubes = [
        row_of(f"cube {row}", time, error, build="uplift build", mode="moments")
        for row, (time, error) in enumerate([(10, 1.0), (20, 2.0), (30, 0.5)])
    ]
    others = [row_of(name, time, 3.0) for name, time in (("fast", 10), ("slow", 40))]
    drawn = [result.method for _, result in drawn_results(panels_of(64)[0], chart_of(*cubes, *others))]
    assert drawn == ["cube 0", "cube 2", "fast", "slow"]


def test_a_panel_without_a_front_is_empty(row_of, chart_of, tmp_path):
    numbers = {key: value for key, value in row_of("one", 1, 1).numbers.items() if "lights" not in key}
    chart = chart_of(row_of("one", 80, 0.4, numbers=numbers))
    write_pictures(chart, tmp_path / "chart.png", tmp_path / "chart.svg")
    text = (tmp_path / "chart.svg").read_text(encoding="utf-8")
    assert 'id="marker-0-' in text
    assert 'id="marker-1-' not in text


def test_the_reader_chooses_the_number_of_colours(row_of, chart_of, tmp_path):
    need(CHROMIUM)
    visible = """[...document.querySelectorAll(".picture svg")].filter(each => each.checkVisibility()).length"""
    with browser() as tab:
        open_page(tab, render_chart(chart_of(row_of("one", 80, 0.4))), tmp_path)
        shown = len(panels_of(64)) + 1
        assert tab.evaluate(visible) == shown
        assert tab.evaluate("document.querySelector('[data-choice=\"64\"]').hidden") is False
        tab.evaluate("document.querySelector('.choice input[value=\"1\"]').click()")
        assert tab.evaluate(visible) == shown
        assert tab.evaluate("document.querySelector('[data-choice=\"64\"]').hidden") is True


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
