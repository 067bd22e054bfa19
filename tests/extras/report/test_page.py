"""Page and JSON of a report: complete, self-contained, and safe for any entry name."""

import json
import re

import numpy as np
import pytest

from tests.browsing import check_page
from tests.extras.report.conftest import HOSTILE
from tests.pages import Page
from uplift.atlas.sources import read_atlas
from uplift.extras.report import page
from uplift.extras.report.assessment import assess
from uplift.extras.report.charts import linear_edges, log_edges, make_histogram
from uplift.extras.report.page import render_report


@pytest.fixture(scope="module")
def html(judged):
    return render_report(judged, worst=3)


def test_page_fits_and_is_accessible(html, tmp_path):
    check_page(html, tmp_path)


def test_page_is_complete_and_sorted_worst_first(html, judged):
    read = Page(html)
    assert "No failures: all 512 nodes" in read.text
    assert judged.values["build"]["digest"] in read.text
    assert not re.search(r"\b(nan|inf|None(?!\.))\b", read.text)
    names = judged.entries.names.tolist()
    rows = read.table("entry", "worst")
    assert [row[0].parts[0] for row in rows] == names
    worst = judged.entries.answers.worst
    assert [row[1].value for row in rows] == pytest.approx(worst.tolist())
    drawn = re.findall(r'<figcaption><b title="[^"]*">([^<]*)</b>', html)
    assert drawn == names[:3]
    values = json.loads(json.dumps(judged.values, allow_nan=False))
    assert [entry["name"] for entry in values["entries"]] == names


@pytest.fixture
def without_charts(monkeypatch):
    """They take most of the time of a page."""
    monkeypatch.setattr(page, "histogram_chart", lambda *_, **__: "")


def test_names_are_escaped(small_cube, hostile, without_charts):
    found = assess(small_cube, HOSTILE, 1, hostile, ("D65",))
    assert found.entries.names.tolist() == [HOSTILE]
    html = render_report(found, worst=24)
    assert HOSTILE not in html
    read = Page(html)
    assert read.tags.count("script") == 1  # the page's own
    assert HOSTILE in read.text
    assert "laser" + HOSTILE in read.text


def test_points_over_the_threshold_are_listed(spoilt, macbeth, without_charts):
    assessment = assess(spoilt, "spoilt.uplift", 1, macbeth, ("D65",))
    text = Page(render_report(assessment, worst=0)).text
    assert "2 nodes of 512 over the threshold of 0.0001." in text
    for rgb in spoilt.data.lattice.points[[100, 300]]:
        assert ", ".join(f"{value:.4f}" for value in rgb) in text


def test_lost_entries_are_named(lossy_cube, without_charts):
    found = assess(lossy_cube, "lossy.uplift", 1, None, ("D65",))
    text = Page(render_report(found, worst=0)).text
    assert "Lost, as an earlier entry has the same colour: über (that of grey)." in text
    lost = found.values["crowding"]["lost"]
    assert lost == [{"name": "über", "same_colour": "grey"}]


def test_predicted_and_actual_errors_are_shown(small_cube, without_charts):
    other = read_atlas("cie2017")[:30]
    found = assess(small_cube, "small.uplift", 1, other, ("D65", "FL11"))
    read = Page(render_report(found, worst=0))
    rows = read.table("entry", "worst", "D65", "FL11", "rms", "predicted", "actual")
    for row, entry in zip(rows, found.values["entries"], strict=True):
        assert row[-2].value == pytest.approx(entry["standard_error"])
        assert row[-1].value == pytest.approx(entry["delta_e_2000_reference"])


def test_histogram_counts_every_value():
    values = np.array([0.0, 1e-12, 3e-7, 0.2, 0.2, 5.0])
    for edges in (log_edges(values, 1e-9), linear_edges(values)):
        histogram = make_histogram(values, edges)
        assert sum(histogram["counts"]) == 6
        assert (np.diff(edges) > 0).all()
        assert (histogram["mean"], histogram["max"]) == (values.mean(), 5.0)
        assert edges[-1] >= 5


def test_entries_outside_the_space_are_among_the_entries(judged, html):
    values = judged.values
    assert len(values["entries"]) == 24
    assert values["atlas"]["outside"] == values["failures"]["left_out"] == []
    (facts,) = [entry for entry in values["entries"] if entry["name"] == "cyan"]
    assert facts["delta_e_2000"]["D65"] < 1e-6
    error = judged.data.atlas.outside.error[0]
    assert facts["delta_e_2000"]["A"] == pytest.approx(error, abs=1e-4)
    assert facts["delta_e_2000_lattice"]["A"] > 1
    assert 0 < facts["reach"] < 1
    close = [entry["name"] for entry in values["crowding"]["entries"]]
    assert "cyan" not in close
    assert "Outside sRGB, and so queried as XYZ" in Page(html).text
