"""Reader and writer of CSV tables."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises, warns
from uplift.atlas import Atlas, Entry, read_atlas, write_atlas
from uplift.common.errors import AtlasError, OutputError

WIDE = "name,400,550,700\nred,0.1,0.2,0.9\nblue,0.8,0.3,0.05\n"
TALL = "wavelength,red,blue\n400,0.1,0.8\n550,0.2,0.3\n700,0.9,0.05\n"


@pytest.mark.parametrize(
    "text",
    [
        WIDE,
        TALL,
        WIDE.replace(",", ";").replace(".", ","),
        TALL.replace(",", ";").replace(".", ","),
        WIDE.replace("\n", ",,\n"),
        WIDE.replace("\n", "\n\n"),
        WIDE.replace(",", " , "),
        WIDE.replace("550", "550 nm").replace("400", "400nm"),
        WIDE.replace("name", "").replace("red", '"red"'),
        "\ufeff" + WIDE,
    ],
)
def test_layouts(save, text):
    spectra = read_atlas(save(text, "table.csv"))
    assert spectra.names == ("red", "blue")
    assert [entry.wavelengths.tolist() for entry in spectra.entries] == [[400, 550, 700]] * 2
    assert [entry.values.tolist() for entry in spectra.entries] == [[0.1, 0.2, 0.9], [0.8, 0.3, 0.05]]


def test_numbers_as_names(save):
    wide = WIDE.replace("red", "1").replace("blue", "2")
    tall = TALL.replace("red", "1").replace("blue", "2")
    for text in (wide, tall):
        spectra = read_atlas(save(text))
        assert spectra.names == ("1", "2")
        assert spectra.entries[0].values.tolist() == [0.1, 0.2, 0.9]


@pytest.mark.parametrize("text", ["name,400,700\nred,10,90\nblue,5,1.5\n", "nm,red,blue\n400,10,5\n700,90,1.5\n"])
def test_percent(save, text):
    with warns("values-in-percent") as caught:
        spectra = read_atlas(save(text))
    assert caught[0].entry == "red"
    assert "90" in caught[0].problem
    assert [entry.values.tolist() for entry in spectra.entries] == [[0.1, 0.9], [0.05, 0.015]]


def test_the_largest_numbers_do_not_overflow(save):
    with np.errstate(over="raise"), warns("values-in-percent"), raises(AtlasError, "atlas"):
        read_atlas(save("name,400,550,700\nred,1e308,1e308,1e308\n"))


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        (WIDE.replace("0.2", "x"), 2, "atlas"),
        (WIDE.replace(",0.9", ""), 2, "atlas"),
        (WIDE.replace("550", "x"), 1, "not-an-atlas"),
        ("name,400,700\n", 1, "not-an-atlas"),
        ("400,0.1,0.2\n550,0.2,0.3\n700,0.9,0.3\n", 1, "atlas"),
        (WIDE.replace("550", "350"), 2, "atlas"),
        (WIDE.replace("700", "690"), 2, "atlas"),
        (WIDE.replace("blue", "red"), 3, "atlas"),
        (WIDE.replace("blue", '"bl\nue"'), 3, "atlas"),
        (WIDE.replace("blue", ""), 3, "atlas"),
        (WIDE.replace("0.2", "-0.2"), 2, "atlas"),
        (WIDE.replace("700", "1e308"), 2, "atlas"),
    ],
)
def test_faults_report_file_and_line(save, text, line, code):
    path = save(text, "table.csv")
    with raises(AtlasError, code) as caught:
        read_atlas(path)
    assert caught.value.where.startswith(f"{path}:{line}")


def test_percent_out_of_range(save):
    path = save(WIDE.replace("0.9", "900"), "table.csv")
    with raises(AtlasError, "atlas") as caught:
        read_atlas(path, measured="percent")
    assert caught.value.where.endswith("table.csv:2: entry 'red'")
    assert "9 at 700 nm" in caught.value.problem


def test_endless_cell_raises(save):
    with raises(AtlasError, "atlas"):
        read_atlas(save('name,"' + "x" * 200_000))
    with raises(AtlasError, "atlas"):
        read_atlas(save(WIDE + '"' + "x" * 200_000))


def test_entries_of_a_table_share_one_sampling(tmp_path):
    entries = (
        Entry("a", np.array([400.0, 700.0]), np.array([0.5, 0.5])),
        Entry("b", np.array([380.0, 700.0]), np.array([0.5, 0.5])),
    )
    with raises(OutputError, "output"):
        write_atlas(Atlas(entries), tmp_path / "out.csv")
    write_atlas(Atlas(entries), tmp_path / "out.txt")
    assert len(read_atlas(tmp_path / "out.txt")) == 2
