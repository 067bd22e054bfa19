"""Pictures and page show every representation; records hold every number."""

from __future__ import annotations

import json
import re

import matplotlib.image
import numpy as np
import pytest

from uplift.lab.comparison.cost import COSTS, front, numbered
from uplift.lab.comparison.page import page
from uplift.lab.comparison.pictures import DRAWN, write_picture
from uplift.lab.comparison.style import COLOURS, OTHER, colour, families
from uplift.lab.comparison.table import records


@pytest.fixture(scope="module")
def pictures(found, tmp_path_factory):
    """SVG by kind, and the folder of the PNG files."""
    folder = tmp_path_factory.mktemp("pictures")
    return {kind: write_picture(found, kind, folder / f"{kind}.png") for kind in DRAWN}, folder


@pytest.mark.parametrize("kind", list(DRAWN))
def test_files_are_pictures(pictures, kind):
    pixels = matplotlib.image.imread(pictures[1] / f"{kind}.png")
    assert pixels.shape[0] > 500
    assert pixels.std() > 0.05


def test_every_representation_has_a_marker_and_a_name_in_every_panel(found, pictures):
    for panel in range(4):
        for number in numbered(found).values():
            for part in ("marker", "label"):
                assert f'id="{part}-{panel}-{number}"' in pictures[0]["cost"]


def test_box_plots_name_every_representation_once_a_panel(found, pictures):
    for name in numbered(found):
        assert len(re.findall(f">{name}<", pictures[0]["boxes"])) == 2


@pytest.mark.parametrize("cost", COSTS, ids=lambda cost: cost.title)
def test_nothing_is_cheaper_and_nearer_than_the_front(found, cost):
    for name in found.sets:
        rows = found.of(name)
        for ahead in front(rows, cost):
            beaten_by = [
                row
                for row in rows
                if cost.of(row) <= cost.of(ahead) and row.statistics.q97_5 < ahead.statistics.q97_5
            ]
            assert not beaten_by


def test_the_page_tells_what_hovering_shows(found, pictures):
    text = page(found, pictures[0])
    (data,) = re.findall(r'<script type="application/json" id="rows">(.*?)</script>', text, re.DOTALL)
    told = json.loads(data)
    assert [one["title"] for one in told] == list(numbered(found))
    assert all(len(one["lines"]) == 1 + 3 * len(found.sets) for one in told)
    assert "Smooth lights (A, B, C)" in text
    assert "http" not in re.sub(r'xmlns="[^"]*"', "", text)
    assert page(found, pictures[0]) == text


def test_families_keep_their_colours(found):
    assert list(families(found.rows)) == [name for name in COLOURS if name in families(found.rows)]
    assert colour("of tomorrow") == OTHER
    assert len(set(COLOURS.values())) == len(COLOURS)


def test_records_hold_every_row(found):
    made = records(found)
    assert [(one["lights"], one["representation"]) for one in made] == [
        (row.lights, row.name) for row in found.rows
    ]
    assert all(np.isfinite([one["mean"], one["q97_5"], one["ns"], one["floats"]]).all() for one in made)
