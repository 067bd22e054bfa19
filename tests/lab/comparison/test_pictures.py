"""Pictures, page and records contain every representation."""

from __future__ import annotations

import json
import re

import matplotlib.image
import numpy as np
import pytest

from tests.browsing import check_page
from tests.pages import Page
from uplift.lab.comparison.compare import records
from uplift.lab.comparison.pictures import (
    COSTS,
    KINDS,
    front,
    numbered,
    page_figures,
    render_comparison,
    write_picture,
)


@pytest.fixture(scope="module")
def pictures(found, tmp_path_factory):
    """The folder of the PNG files."""
    folder = tmp_path_factory.mktemp("pictures")
    for kind in KINDS:
        write_picture(found, kind, folder / f"{kind}.png")
    return folder


@pytest.fixture(scope="module")
def html(found):
    return render_comparison(found)


@pytest.mark.parametrize("kind", list(KINDS))
def test_files_are_images(pictures, kind):
    pixels = matplotlib.image.imread(pictures / f"{kind}.png")
    assert pixels.shape[0] > 500
    assert pixels.std() > 0.05


def test_representations_have_a_marker_in_every_panel(found, html):
    for panel in range(4):
        for number in numbered(found).values():
            assert html.count(f'id="marker-{panel}-{number}"') == 1


def test_box_plots_label_every_representation_once_per_panel(found):
    for svg in page_figures(found):
        for name in numbered(found):
            assert len(re.findall(f">{name}<", svg)) == 2


def test_page_fits_and_is_accessible(html, tmp_path):
    check_page(html, tmp_path)


@pytest.mark.parametrize("cost", COSTS, ids=lambda cost: cost.title)
def test_nothing_is_cheaper_and_more_accurate_than_the_front(found, cost):
    for name in found.sets:
        rows = found.of(name)
        for ahead in front(rows, cost):
            beaten_by = [
                row for row in rows if cost.of(row) <= cost.of(ahead) and row.statistics.q97_5 < ahead.statistics.q97_5
            ]
            assert not beaten_by


def test_page_contains_tooltips_and_tables(found, html):
    text = html
    (data,) = re.findall(r'<script type="application/json" id="rows">(.*?)</script>', text, re.DOTALL)
    tooltips = json.loads(data)
    assert [one["title"] for one in tooltips] == list(numbered(found))
    assert all(len(one["lines"]) == 1 + 3 * len(found.sets) for one in tooltips)
    assert "Smooth lights (A, B, C)" in text
    assert "http:" not in re.sub(r'xmlns="[^"]*"', "", text)
    assert render_comparison(found) == text
    read = Page(text)
    for name in found.sets:
        names = [result.name for result in found.of(name)]
        assert names in [[row[0].parts[0] for row in table[1:]] for table in read.tables]


def test_records_contain_every_result(found):
    made = records(found)
    assert [(one["lights"], one["representation"]) for one in made] == [(row.lights, row.name) for row in found.results]
    assert all(np.isfinite([one["mean"], one["q97_5"], one["ns"], one["floats"]]).all() for one in made)
