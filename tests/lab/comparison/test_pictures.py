"""Pictures, page and records contain every representation."""

from __future__ import annotations

import json
import re

import matplotlib.image
import numpy as np
import pytest

from tests.pages import Page
from uplift.lab.comparison.cost import COSTS, front, numbered
from uplift.lab.comparison.families import COLOURS, family_colour, family_colours
from uplift.lab.comparison.page import render_comparison
from uplift.lab.comparison.pictures import KINDS, write_picture
from uplift.lab.comparison.table import records
from uplift.viz.figure import OTHER


@pytest.fixture(scope="module")
def pictures(found, tmp_path_factory):
    """SVG elements by kind, and the folder of the PNG files."""
    folder = tmp_path_factory.mktemp("pictures")
    return {kind: write_picture(found, kind, folder / f"{kind}.png") for kind in KINDS}, folder


@pytest.mark.parametrize("kind", list(KINDS))
def test_files_are_images(pictures, kind):
    pixels = matplotlib.image.imread(pictures[1] / f"{kind}.png")
    assert pixels.shape[0] > 500
    assert pixels.std() > 0.05


def test_representations_have_marker_and_label_in_every_panel(found, pictures):
    for panel in range(4):
        for number in numbered(found).values():
            for part in ("marker", "label"):
                assert f'id="{part}-{panel}-{number}"' in pictures[0]["cost"]


def test_box_plots_label_every_representation_once_per_panel(found, pictures):
    for name in numbered(found):
        assert len(re.findall(f">{name}<", pictures[0]["boxes"])) == 2


@pytest.mark.parametrize("cost", COSTS, ids=lambda cost: cost.title)
def test_nothing_is_cheaper_and_more_accurate_than_the_front(found, cost):
    for name in found.sets:
        rows = found.of(name)
        for ahead in front(rows, cost):
            beaten_by = [
                row
                for row in rows
                if cost.of(row) <= cost.of(ahead) and row.statistics.q97_5 < ahead.statistics.q97_5
            ]
            assert not beaten_by


def test_page_contains_tooltips_and_tables(found, pictures):
    text = render_comparison(found, pictures[0])
    (data,) = re.findall(r'<script type="application/json" id="rows">(.*?)</script>', text, re.DOTALL)
    tooltips = json.loads(data)
    assert [one["title"] for one in tooltips] == list(numbered(found))
    assert all(len(one["lines"]) == 1 + 3 * len(found.sets) for one in tooltips)
    assert "Smooth lights (A, B, C)" in text
    assert "http:" not in re.sub(r'xmlns="[^"]*"', "", text)
    assert render_comparison(found, pictures[0]) == text
    read = Page(text)
    for name in found.sets:
        names = [result.name for result in found.of(name)]
        assert names in [[row[0].parts[0] for row in table[1:]] for table in read.tables]


def test_families_have_fixed_colours_and_order(found):
    present = {result.family for result in found.results}
    assert list(family_colours(present)) == [name for name in COLOURS if name in present]
    assert family_colours(["unknown", "sigmoid"]) == {"sigmoid": COLOURS["sigmoid"], "unknown": OTHER}
    assert family_colour("unknown") == OTHER
    assert len(set(COLOURS.values())) == len(COLOURS)


def test_records_contain_every_result(found):
    made = records(found)
    assert [(one["lights"], one["representation"]) for one in made] == [
        (row.lights, row.name) for row in found.results
    ]
    assert all(np.isfinite([one["mean"], one["q97_5"], one["ns"], one["floats"]]).all() for one in made)
