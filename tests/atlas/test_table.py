"""Tables of reflectances."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.atlas import Atlas, Entry, read_atlas, write_atlas
from uplift.common.errors import AtlasError, OutputError, UpliftWarning

WIDE = "name,400,550,700\nred,0.1,0.2,0.9\nblue,0.8,0.3,0.05\n"
TALL = "wavelength,red,blue\n400,0.1,0.8\n550,0.2,0.3\n700,0.9,0.05\n"


@pytest.mark.parametrize(
    "text",
    [
        WIDE,
        TALL,
        WIDE.replace(",", ";"),
        TALL.replace(",", "\t"),
        WIDE.replace(",", ";").replace(".", ","),
        TALL.replace(",", ";").replace(".", ","),
        WIDE.replace("\n", "\r\n"),
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


def test_lines_of_entries(save):
    assert [entry.line for entry in read_atlas(save(WIDE.replace("\n", "\n\n"))).entries] == [3, 5]


def test_numbers_as_names(save):
    wide = WIDE.replace("red", "1").replace("blue", "2")
    tall = TALL.replace("red", "1").replace("blue", "2")
    for text in (wide, tall):
        spectra = read_atlas(save(text))
        assert spectra.names == ("1", "2")
        assert spectra.entries[0].values.tolist() == [0.1, 0.2, 0.9]


@pytest.mark.parametrize(
    "text", ["name,400,700\nred,10,90\nblue,5,1.5\n", "nm,red,blue\n400,10,5\n700,90,1.5\n"]
)
def test_percent(save, text):
    with pytest.warns(
        UpliftWarning, match=r"values up to 90 \(entry 'red'\): read as percent, divided by 100"
    ):
        spectra = read_atlas(save(text))
    assert [entry.values.tolist() for entry in spectra.entries] == [[0.1, 0.9], [0.05, 0.015]]


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (WIDE.replace("0.2", "x"), 2, "entry 'red': value 'x' is not a number; write a plain number"),
        (WIDE.replace("0.2", ""), 2, "entry 'red': value '' is not a number; write a plain number"),
        (TALL.replace("0.3", "x"), 3, "entry 'blue': value 'x' is not a number; write a plain number"),
        (WIDE.replace(",0.9", ""), 2, "3 cells, the header row has 4; fill in the missing cells"),
        (WIDE.replace("0.9", "0.9,1"), 2, "5 cells, the header row has 4; fill in the missing cells"),
        (WIDE.replace("550", "x"), 1, "neither an atlas text (no 'Entry ID') nor a table of reflectances"),
        (
            "name,400,700\n",
            1,
            "neither an atlas text (no 'Entry ID') nor a table of reflectances; write a header",
        ),
        ("400,0.1\n550,0.2\n700,0.9\n", 1, "the header row is missing; write a header row of wavelengths"),
        (WIDE.replace("0.2", "nan"), 2, "entry 'red': sample 2 is not finite: nan at 550 nm; replace it"),
        (WIDE.replace("550", "350"), 2, "entry 'red': wavelengths do not ascend: 400 nm, then 350 nm; sort"),
        (WIDE.replace("700", "690"), 2, "entry 'red': covers 400–690 nm, not the visible 400–700 nm; add"),
        (WIDE.replace("blue", "red"), 3, "entry 'red': the name is taken: first used at"),
        (
            WIDE.replace("blue", '"bl\nue"'),
            3,
            "entry 'bl ue': the name has line breaks or blanks around it; give",
        ),
        (WIDE.replace("blue", ""), 3, "entry '': an entry has no name; give every entry a name"),
        (
            WIDE.replace("0.2", "-0.2"),
            2,
            "entry 'red': reflectance -0.2 at 550 nm is out of range; the scale",
        ),
        (WIDE.replace("700", "1e308"), 2, "entry 'red': wavelength 1e+308 nm is out of range; give wave"),
    ],
)
def test_faults_name_file_line_entry_and_remedy(save, text, line, message):
    path = save(text, "table.csv")
    with pytest.raises(AtlasError) as caught:
        read_atlas(path)
    assert str(caught.value).startswith(f"{path}:{line}: {message}")


def test_percent_out_of_range(save):
    with (
        pytest.warns(UpliftWarning, match="read as percent"),
        pytest.raises(
            AtlasError, match=r"table\.csv:2: entry 'red': reflectance 9 at 700 nm is out of range"
        ),
    ):
        read_atlas(save(WIDE.replace("0.9", "900"), "table.csv"))


def test_an_endless_cell_is_an_atlas_error(save):
    with pytest.raises(AtlasError, match="no readable table"):
        read_atlas(save('name,"' + "x" * 200_000))
    with pytest.raises(AtlasError, match="no readable table"):
        read_atlas(save(WIDE + '"' + "x" * 200_000))


def test_a_table_has_one_sampling(tmp_path):
    entries = (
        Entry("a", np.array([400.0, 700.0]), np.array([0.5, 0.5])),
        Entry("b", np.array([380.0, 700.0]), np.array([0.5, 0.5])),
    )
    with pytest.raises(
        OutputError, match="entries 'a' and 'b' are sampled at different wavelengths; write atlas text"
    ):
        write_atlas(Atlas(entries), tmp_path / "out.csv")
    write_atlas(Atlas(entries), tmp_path / "out.txt")
    assert len(read_atlas(tmp_path / "out.txt")) == 2
