"""Report of an emission table: its numbers, and a page that is complete, self-contained and safe."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import uplift
from tests.browsing import check_page
from tests.pages import Page
from tests.report.conftest import HOSTILE
from uplift.lights.lookup import EmissionTable
from uplift.report.light_page import render_light_report
from uplift.report.lights import assess_lights, lights_to_json


@pytest.fixture(scope="module")
def found():
    return assess_lights(uplift.load_emission(), "emission.uplift", 907960)


@pytest.fixture(scope="module")
def html(found):
    return render_light_report(found)


def test_page_fits_and_is_accessible(html, tmp_path):
    check_page(html, tmp_path)


def test_page_is_complete_and_loads_nothing(html, found):
    read = Page(html)
    for heading in ("Build", "Chromaticity diagrams", "Random lights", "Lamps", "No negative power"):
        assert heading in read.text
    assert found.facts["digest"] in read.text
    assert not re.search(r"\b(nan|inf|None)\b", read.text)
    assert set(re.findall(r"https?://[^\"'\s<)]*", html)) == {"http://www.w3.org/2000/svg"}
    links = {value for name, value in read.attributes if name in ("href", "xlink:href", "src")}
    assert {re.match("#|data:image/png", link)[0] for link in links} == {"#", "data:image/png"}
    names = re.findall(r' id="([^"]+)"', html)
    assert len(names) == len(set(names))


def test_the_table_has_all_lamps(html, found):
    rows = Page(html).table("lamp", "colour")
    assert [row[0].parts[0] for row in rows] == list(found.table.lamp_names)
    assert [row[-1].value for row in rows] == pytest.approx(found.lamp_errors, rel=1e-6)


def test_colours_are_exact_and_powers_are_not_negative(found):
    assert found.round_trip.largest < 1e-6
    assert found.smallest_power >= 0
    assert 0 < found.expected_error.median < 10


def test_wrong_tables_fail(found):
    """The measures see a table whose lattice has other colours: the test above can fail."""
    data = found.table.data
    shifted = np.roll(data.spectra, 1, axis=2)
    wrong = assess_lights(EmissionTable(replace(data, spectra=shifted)), "wrong.uplift", 1)
    assert wrong.round_trip.largest > 1e-3


def test_negative_powers_are_stated_and_names_are_escaped(found):
    data = found.table.data
    entries = replace(data.entries, names=(HOSTILE, *data.entries.names[1:]))
    table = EmissionTable(replace(data, entries=entries, spectra=data.spectra - np.float32(1e-3)))
    dark = assess_lights(table, HOSTILE, 1)
    assert dark.smallest_power < 0
    html = render_light_report(dark)
    assert 'class="bad"><b>Negative power' in html
    assert HOSTILE not in html
    assert HOSTILE in Page(html).text


def test_json_has_the_numbers(found):
    values = json.loads(json.dumps(lights_to_json(found), allow_nan=False))
    assert values["round_trip_uv"]["max"] == found.round_trip.largest
    assert values["smallest_power"] == found.smallest_power
    assert [lamp["name"] for lamp in values["lamps"]] == list(found.table.lamp_names)
    assert values["lamps"][0]["expected_error"] == found.lamp_errors[0]
