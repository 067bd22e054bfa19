"""Report of an emission table: its numbers, and a page that is complete, self-contained
and safe.
"""

import re
from dataclasses import replace

import numpy as np
import pytest

import uplift
from tests.browsing import check_page
from tests.extras.report.conftest import HOSTILE
from tests.pages import Page
from uplift.extras.emission.file import emission_digest
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.report.emission_page import assess_lights, render_light_report

TABLE = uplift.load_emission()


@pytest.fixture(scope="module")
def found():
    return assess_lights(TABLE)


@pytest.fixture(scope="module")
def html():
    return render_light_report(TABLE, "emission.uplift", 907960)


def test_page_fits_and_is_accessible(html, tmp_path):
    check_page(html, tmp_path)


def test_page_is_complete(html):
    read = Page(html)
    for heading in (
        "Build",
        "Chromaticity diagrams",
        "Random lights",
        "Lamps",
        "No negative power",
    ):
        assert heading in read.text
    assert emission_digest(TABLE.data) in read.text
    assert not re.search(r"\b(nan|inf|None)\b", read.text)
    names = re.findall(r' id="([^"]+)"', html)
    assert len(names) == len(set(names))


def test_the_table_has_all_lamps(html, found):
    rows = Page(html).table("lamp", "colour")
    assert [row[0].parts[0] for row in rows] == list(TABLE.lamp_names)
    assert [row[-1].value for row in rows] == pytest.approx(
        found["lamp_errors"], rel=1e-6
    )


def test_colours_are_exact_and_powers_are_not_negative(found):
    assert found["round_trip"].max < 1e-6
    assert found["smallest_power"] >= 0
    assert 0 < found["expected_error"].median < 10


def test_negative_powers_are_stated_and_names_are_escaped():
    data = TABLE.data
    entries = replace(data.entries, names=(HOSTILE, *data.entries.names[1:]))
    table = EmissionTable(
        replace(data, entries=entries, spectra=data.spectra - np.float32(1e-3))
    )
    html = render_light_report(table, HOSTILE, 1)
    assert 'class="bad"><b>Negative power' in html
    assert HOSTILE not in html
    assert HOSTILE in Page(html).text
