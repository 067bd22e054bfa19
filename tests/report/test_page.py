"""The page and the numbers of a report: whole, alone, and safe whatever the names are."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.helpers import with_points
from tests.report.conftest import HOSTILE
from uplift.atlas import read_atlas
from uplift.lookup import MODES, Cube
from uplift.report.assessment import assess
from uplift.report.charts import histogram_chart, spectra_chart
from uplift.report.json_export import to_json
from uplift.report.page import page
from uplift.viz.format import format_power_of_ten, format_scientific
from uplift.viz.histogram import histogram, log_edges
from uplift.viz.markup import EMPTY, Markup, element


class Reader(HTMLParser):
    """Elements that end where they should; text and attributes as a browser would have them."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.attributes, self.words = [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if not self.open or self.open[-1] not in ("style", "script"):
            self.words.append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


@pytest.fixture(scope="module")
def html(judged):
    return page(judged, worst=3)


def test_the_page_is_well_formed_and_says_all(html, judged):
    read = Reader(html)
    for heading in ("Build", "Failures", "Distributions", "Standard error", "Crowding", "Entries"):
        assert heading in read.text
    for name in judged.entries.names:
        assert name in read.text
    assert "Nothing failed: all 512 points" in read.text
    assert judged.facts["digest"] in read.text
    assert "Left out, as sRGB does not hold them: cyan." in read.text
    assert not re.search(r"\b(nan|inf|None)\b", read.text)


def test_the_page_needs_nothing_else(html):
    assert set(re.findall(r"https?://[^\"'\s<)]*", html)) == {"http://www.w3.org/2000/svg"}
    read = Reader(html)
    assert not {"link", "img", "iframe", "object"} & set(read.tags)
    assert not [value for name, value in read.attributes if name in ("src", "srcset")]
    assert {value[0] for name, value in read.attributes if name in ("href", "xlink:href")} == {"#"}
    assert "@import" not in html
    assert set(re.findall(r"url\((.)", html)) <= {"#"}


def test_identifiers_are_unique_and_lead_somewhere(html):
    names = re.findall(r' id="([^"]+)"', html)
    assert len(names) == len(set(names))
    assert set(re.findall(r'(?:href="|url\()#([^")]+)', html)) <= set(names)


def test_charts_are_xml_and_as_many_as_asked_for(html, judged):
    charts = re.findall(r"<svg.*?</svg>", html, re.DOTALL)
    for chart in charts:
        ElementTree.fromstring(chart)
    keys, lattice, errors, trips, lights = 3, 2, 1, len(MODES), len(judged.lights)
    assert len(charts) == keys + lattice + errors + trips + lights + 3


def test_the_same_cube_gives_the_same_page(html, judged):
    assert page(judged, worst=3) == html


def test_worst_first_in_table_and_plots(html, judged):
    table = html[html.index("Entry by entry") :]
    rows = re.findall(r'<td class="name">([^<]*)<', table)
    assert rows == list(judged.entries.names)
    drawn = re.findall(r'<figcaption><b title="[^"]*">([^<]*)</b>', html)
    assert drawn == list(judged.entries.names[:3])


def test_no_plots_if_none_are_wanted(judged):
    text = page(judged, worst=0)
    Reader(text)
    assert 'class="grid"' not in text


def test_names_are_text_whatever_they_hold(small_cube, hostile):
    found = assess(small_cube, HOSTILE, 1, hostile, ("D65",))
    assert found.entries.names == (HOSTILE,)
    html = page(found, worst=24)
    assert HOSTILE not in html
    read = Reader(html)
    assert read.tags.count("script") == 1  # the page's own
    assert HOSTILE in read.text
    assert "laser" + HOSTILE in read.text
    assert "which the cube was not built from" in read.text
    assert "lattice by itself" not in read.text[read.text.index("Entries") :].split("Entry by entry")[1]


def test_points_over_the_threshold_are_named(spoilt, macbeth):
    read = Reader(page(assess(spoilt, "spoilt.uplift", 1, macbeth, ("D65",)), worst=0))
    assert "2 lattice points of 512 over the threshold of 0.0001." in read.text
    assert "2 over the threshold" in read.text
    assert "Nothing failed" not in read.text
    for point in (100, 300):
        assert ", ".join(f"{value:.4f}" for value in spoilt.data.lattice.points[point]) in read.text


def test_without_an_atlas_the_page_says_so(small_sigmoid_cube):
    read = Reader(page(assess(small_sigmoid_cube, "sigmoid.uplift", 1, None, ("D65",)), worst=24))
    assert "built without an atlas, and none was given" in read.text
    assert "Crowding" not in read.text


def test_the_crowded_are_listed(crowded_cube, macbeth, hostile):
    for spectra, wanted in ((macbeth, "measured"), (hostile, "stored")):
        found = assess(crowded_cube, "crowded.uplift", 1, spectra, ("D65", "A"))
        html = page(found, worst=0)
        section = html[html.index("<h2>Crowding") : html.index("<h2>Entries")]
        assert f"against the {wanted} spectrum" in section
        assert "uplift build --dim auto" in section
        assert "Lost" not in section
        rows = re.findall(r'<tr><td class="name">([^<]*)<', section)
        assert rows == list(found.crowding.entries.names)
        worst = re.findall(
            r'data-value="[^"]*"><span class="stack"><span[^>]*>([\d.]+)</span><span[^>]*>([\d.]+)', section
        )
        shown = found.crowding.entries
        pairs = [f"{value:.2f}" for value in (shown.worst[0], shown.worst_lattice[0])]
        assert list(worst[0]) == pairs
        assert to_json(found)["crowding"]["against"] == wanted


def test_the_lost_are_named(lossy_cube):
    found = assess(lossy_cube, "lossy.uplift", 1, None, ("D65",))
    read = Reader(page(found, worst=0))
    assert "Lost, as an earlier entry has the same colour: über (that of grey)." in read.text
    assert "2 entries crowd" in read.text
    assert "; 1 lost" in read.text
    told = json.loads(json.dumps(to_json(found), allow_nan=False))["crowding"]
    assert told["lost"] == [{"name": "über", "same_colour": "grey"}]
    assert {entry["name"]: entry["reach"] for entry in told["entries"]} == {"grey": 0.5, "über": 0}


def test_stated_errors_stand_beside_real_ones(small_cube, repository):
    other = read_atlas(repository / "atlases" / "cie2017.txt")
    found = assess(small_cube, "small.uplift", 1, other, ("D65",))
    html, judged = page(found, worst=0), found.calibration
    text = Reader(html).text
    assert f"expected to miss by ΔE00 {judged.stated:.2f} under A, and missed by {judged.real:.2f}" in text
    assert "It is too sure of itself" in text
    assert f"{judged.within_one:.0%} of the entries lie within one standard error" in text
    assert f"mean {found.standard_error.mean:.2f}, ΔE00 under A" in text
    assert re.search(r">stated</th><th[^>]*>real</th></tr>", html)
    told = to_json(found)
    assert told["standard_error"]["calibration"]["within_two"] == judged.within_two
    ends = re.findall(
        r'data-value="([^"]*)"><span>[\d.]+</span></td><td class="number" data-value="([^"]*)">[^/]*/span></td></tr>',
        html,
    )
    assert [[float(value) for value in end] for end in ends] == pytest.approx(
        np.array([(entry["standard_error"], entry["delta_e_2000_reference"]) for entry in told["entries"]])
    )


def test_a_cube_that_states_no_errors_says_why(plain_cube, lossy_cube, macbeth):
    few = Cube(with_points(lossy_cube.data, standard_error=None))
    for cube, why in ((plain_cube, "built without an atlas, so nothing"), (few, "its 2 entries are too few")):
        found = assess(cube, "none.uplift", 1, macbeth, ("D65",))
        text = Reader(page(found, worst=0)).text
        assert "The cube states none: " in text
        assert why in text
        assert to_json(found)["standard_error"]["delta_e_2000"] is None
        assert {entry["standard_error"] for entry in to_json(found)["entries"]} <= {None}
        assert "stated" not in text


def test_nobody_crowds(macbeth_cube, macbeth):
    read = Reader(page(assess(macbeth_cube, "macbeth-32.uplift", 1, macbeth, ("D65",)), worst=0))
    assert "No entry has another within a lattice step." in read.text
    assert "No entry crowds" in read.text


def test_numbers_are_those_of_the_assessment_and_json(judged):
    found = json.loads(json.dumps(to_json(judged), allow_nan=False))
    assert found["cube"] == "small.uplift"
    assert found["lights"] == ["D65", "A", "FL11"]
    assert [entry["name"] for entry in found["entries"]] == list(judged.entries.names)
    assert list(found["entries"][0]["delta_e_2000"].values()) == judged.entries.delta_e[0].tolist()
    assert found["entries"][0]["srgb"]["A"]["answered"].startswith("#")
    assert found["fitting_distance"]["max"] == judged.distance.largest
    assert sum(found["round_trip"]["delta_e_2000"]["moments"]["counts"]) == found["round_trip"]["colours"]
    crowded = [entry["name"] for entry in found["crowding"]["entries"]]
    assert crowded == list(judged.crowding.entries.names)
    first = found["entries"][0]
    assert list(first["delta_e_2000_lattice"].values()) == judged.entries.delta_e_lattice[0].tolist()
    assert (first["reach"], first["standard_error"]) == (judged.entries.reach[0], judged.entries.stated[0])
    assert found["standard_error"]["light"] == "A"
    assert found["standard_error"]["delta_e_2000"]["mean"] == judged.standard_error.mean
    assert found["standard_error"]["calibration"] is None
    assert found["failures"]["over_threshold"] == 0


def test_numbers_without_entries_and_with_failures(spoilt):
    found = json.loads(json.dumps(to_json(assess(spoilt, "spoilt.uplift", 1, None, ("A",))), allow_nan=False))
    assert (found["entries"], found["delta_e_2000"]) == ([], {})
    assert [point["distance"] for point in found["failures"]["worst"]] == pytest.approx([0.02, 0.01])


def test_markup_escapes_all_but_markup():
    made = element("p", "<b> & ", Markup("<br>"), None, title='"<', class_="x", data_value=1)
    assert made == '<p title="&quot;&lt;" class="x" data-value="1">&lt;b&gt; &amp; <br></p>'


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (1.6e-5, "1.6\u00a0×\u00a010⁻⁵"),
        (0.0271, "0.0271"),
        (2.7, "2.70"),
        (506.2, "506"),
        (np.nan, "not finite"),
    ],
)
def test_numbers_as_the_page_writes_them(value, text):
    assert format_scientific(value) == text


def test_decades():
    assert (format_power_of_ten(1e-9), format_power_of_ten(1.0)) == ("10⁻⁹", "10⁰")


def test_charts_stand_alone():
    at = np.arange(380.0, 781.0, 5.0)
    values = np.geomspace(1e-8, 1e-3, 50)
    charts = [
        histogram_chart(histogram(values, log_edges(values, 1e-9)), "distance", threshold=1e-4),
        spectra_chart(at, np.full(81, 0.05), np.full(81, 0.06), None),
        spectra_chart(at, np.full(81, 0.5), np.full(81, 1.0), np.full(81, 0.4)),
    ]
    assert len(set(charts)) == 3
    for chart in charts:
        ElementTree.fromstring(chart)
