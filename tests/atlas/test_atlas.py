"""`Atlas` as a sequence with names, and its representations."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tests.atlas.atlas_texts import ATLASES
from tests.helpers import raises
from uplift.atlas import Atlas, Entry, SkippedEntry, Source, read_atlas
from uplift.common.errors import UnknownNameError

RED = Entry("red", [400, 550, 700], [0.0, 0.0, 1.0])
GREY = Entry("grey", [380, 780], [0.5, 0.5])
ATLAS = Atlas((RED, GREY), (SkippedEntry("lamp", "emits"),), (Source("a.txt", "00"),))


def test_iteration_length_and_membership():
    assert list(ATLAS) == [RED, GREY]
    assert len(ATLAS) == 2
    assert "red" in ATLAS
    assert RED in ATLAS
    assert "blue" not in ATLAS
    assert Entry("red", RED.wavelengths, RED.values) not in ATLAS


def test_index_is_a_name_a_position_or_a_slice():
    assert ATLAS["grey"] is GREY
    assert ATLAS[0] is RED
    assert ATLAS[-1] is GREY
    part = ATLAS[1:]
    assert isinstance(part, Atlas)
    assert part.names == ("grey",)
    assert part.sources == ATLAS.sources


def test_unknown_name_raises_with_near_names():
    with raises(UnknownNameError, "unknown-atlas-entry") as caught:
        ATLAS["gray"]
    assert "'grey'" in caught.value.hint
    with pytest.raises(KeyError):
        ATLAS["gray"]
    with pytest.raises(IndexError):
        ATLAS[2]


def test_repr_is_one_short_line():
    assert repr(ATLAS) == "Atlas(2 entries, 380–780 nm, 1 skipped, from a.txt)"
    assert repr(Atlas()) == "Atlas(0 entries)"
    assert repr(ATLAS[:1]).startswith("Atlas(1 entry, 400–700 nm")
    assert repr(RED) == "Entry('red', 3 samples, 400–700 nm)"


def test_html_has_a_row_with_swatch_name_and_plot_per_entry():
    table = ElementTree.fromstring(read_atlas(ATLASES / "macbeth.txt")._repr_html_())
    rows = table.findall("tr")
    assert len(rows) == 24
    names = [row.findall("td")[1].text for row in rows]
    assert "orange" in names
    points = rows[0].find(".//polyline").get("points").split()
    assert len(points) == 81


def test_html_escapes_names():
    html = Entry("<script>&", GREY.wavelengths, GREY.values)._repr_html_()
    assert "<script>" not in html
    assert "&lt;script&gt;&amp;" in html
