"""The files of atlases/ agree with tools/ship_atlases.py and the tables of colour-science."""

from __future__ import annotations

import runpy

import colour
import numpy as np
import pytest

from tests.atlas.atlas_texts import ATLASES
from tests.helpers import warns
from uplift.atlas import on_grid, read_atlas

GRID = np.arange(380.0, 785.0, 5.0)
SHIPPED = {
    "babelcolor.txt": (24, 380, 730, 10),
    "cie2017.txt": (99, 380, 780, 5),
    "macbeth.txt": (24, 380, 780, 5),
    "pmc.txt": (30, 400, 700, 10),
    "rawtoaces.txt": (190, 380, 780, 5),
    "tcs.txt": (14, 360, 830, 5),
    "vs.txt": (15, 360, 830, 5),
}


@pytest.mark.parametrize("file", SHIPPED)
def test_entries_range_step_and_licence(file):
    count, start, end, step = SHIPPED[file]
    spectra = read_atlas(ATLASES / file)
    assert len(spectra) == count
    assert not spectra.skipped
    for entry in spectra.entries:
        assert (entry.wavelengths[0], entry.wavelengths[-1], entry.step) == (start, end, step)
    header = spectra.sources[0].header
    assert "colour-science" in header.copyright
    assert "BSD-3-Clause" in header.licence


def test_readme_lists_every_file():
    table = (ATLASES / "README.md").read_text(encoding="utf-8")
    assert sorted(SHIPPED) == sorted(path.name for path in ATLASES.glob("*.txt"))
    for file, (count, start, end, step) in SHIPPED.items():
        assert f"| `{file}` | {count} | {start}–{end}, {step} |" in table


def test_all_files_form_one_atlas():
    assert len(read_atlas(*(ATLASES / file for file in SHIPPED))) == sum(row[0] for row in SHIPPED.values())


def test_measured_values_are_unchanged():
    spectra = read_atlas(ATLASES / "macbeth.txt")
    for entry, sd in zip(
        spectra.entries, colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"].values(), strict=True
    ):
        np.testing.assert_array_equal(entry.values, sd.values)


def test_patches_above_1_are_clipped_with_a_warning():
    spectra = read_atlas(ATLASES / "rawtoaces.txt")
    with warns(*["entry-clipped"] * 5) as caught:
        on_grid(spectra, GRID)
    assert [warning.entry for warning in caught] == [
        "patch085",
        "patch089",
        "patch114",
        "patch125",
        "patch128",
    ]


def test_tool_writes_the_same_bytes(tmp_path):
    tool = runpy.run_path(str(ATLASES.parent / "tools" / "ship_atlases.py"))
    tool["main"](tmp_path)
    for file in SHIPPED:
        assert (tmp_path / file).read_bytes() == (ATLASES / file).read_bytes()
