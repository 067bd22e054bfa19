"""Files in general and tables: unreadable ones, sources, and round trips that keep
every bit.
"""

import hashlib
import os
import tempfile
import warnings

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.atlas.atlas_texts import PLAIN
from tests.helpers import raises, warns
from uplift.atlas.atlas import Atlas, Entry, Header
from uplift.atlas.sources import read_atlas, write_atlas
from uplift.common.errors import AtlasError, OutputError, UpliftWarning
from uplift.extras.formats.quantities import POWER, REFLECTANCE, name_quantities
from uplift.extras.formats.statements import remark_scale

GREY = Atlas((Entry("grey", np.array([400.0, 700.0]), np.array([0.5, 0.25])),))


@pytest.mark.parametrize(
    ("content", "code"),
    [
        ("", "atlas"),
        ("\ufeff\n\u2028", "atlas"),
        ("a\nb\0c", "atlas"),
        (PLAIN.encode("utf-16")[:-1], "atlas"),
        ("hello world\n", "not-an-atlas"),
        (",,,\n,,\n", "not-an-atlas"),
    ],
)
def test_files_without_an_atlas_raise(save, content, code):
    path = save(content)
    with raises(AtlasError, code) as caught:
        read_atlas(path)
    assert caught.value.where.startswith(str(path))


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("none.txt", "file-not-found"),
        (".", "file-unreadable"),
        ("a\0b", "file-unreadable"),
    ],
)
def test_unreadable_files_raise(path, code):
    with raises(AtlasError, code):
        read_atlas(path)


def test_content_determines_the_format(read):
    assert read(PLAIN, "atlas.csv").names == ("grey",)
    assert read("name,400,700\nblue,0.5,0.25\n", "atlas.ark").names == ("blue",)


def test_several_files_make_one_atlas_in_order(save):
    paths = [
        save(PLAIN.replace("grey", name).replace("\n", "\r\n"), f"{name}.txt")
        for name in "cab"
    ]
    spectra = read_atlas(*paths)
    assert spectra.names == ("c", "a", "b")
    assert [source.name for source in spectra.sources] == ["c.txt", "a.txt", "b.txt"]
    assert (
        spectra.sources[0].digest == hashlib.sha256(paths[0].read_bytes()).hexdigest()
    )
    assert len(read_atlas()) == 0


def test_duplicate_name_reports_both_locations(save):
    first = save(PLAIN, "a.txt")
    second = save(PLAIN, "b.txt")
    twice = save(PLAIN + PLAIN, "c.txt")
    for paths, at, known in (
        ([first, second], f"{second}:1", first),
        ([twice], f"{twice}:19", twice),
    ):
        with raises(AtlasError, "atlas") as caught:
            read_atlas(*paths)
        assert caught.value.where == f"{at}: entry 'grey'"
        assert f"{known}:1" in caught.value.problem


def test_header_survives_a_round_trip(tmp_path):
    header = Header("greys", "(c) A. Person", "CC0")
    write_atlas(GREY, tmp_path / "a.txt", header)
    found = read_atlas(tmp_path / "a.txt")
    assert found.sources[0].header == header
    write_atlas(found, tmp_path / "b.txt")
    assert (tmp_path / "b.txt").read_bytes() == (tmp_path / "a.txt").read_bytes()


def test_atlases_that_cannot_be_written_raise(tmp_path):
    other = Entry("other", np.array([380.0, 700.0]), np.array([0.5, 0.5]))
    (tmp_path / "file").write_text("")
    for atlas, path, code in (
        (GREY, tmp_path, "output"),
        (GREY, tmp_path / "file" / "out.txt", "output"),
        (GREY, tmp_path / ("x" * 300), "output"),
        (Atlas(), tmp_path / "out.txt", "output"),
        (
            Atlas((*GREY, other)),
            tmp_path / "out.csv",
            "output",
        ),  # one row of wavelengths
    ):
        with raises(OutputError, code):
            write_atlas(atlas, path)
    assert os.listdir(tmp_path) == ["file"]


STATEMENTS = (
    "name",
    "description",
    "additional_description",
    "device",
    "measured_by",
    "date",
)
NAMES = st.text(
    st.characters(codec="utf-8", exclude_categories=["Cc", "Zl", "Zp"]),
    min_size=1,
    max_size=20,
)
TEXTS = st.text('ab" :{}-', max_size=12).map(lambda text: " ".join(text.split()))
REFLECTANCES = st.floats(-0.05, 1.0)
INNER = st.floats(1.0, 2000.0).map(lambda nm: round(nm, 4))


@st.composite
def samplings(draw):
    """Irregular wavelengths, or regular ones with any start and step that cover the
    visible range.
    """
    if draw(st.booleans()):
        return np.unique([400.0, 700.0, *draw(st.lists(INNER, max_size=8))])
    start = draw(st.floats(300.0, 400.0))
    step = draw(st.floats(5.0, 100.0))
    return start + step * np.arange(int(np.ceil((701.0 - start) / step)) + 1)


@st.composite
def atlases(draw, one_sampling):
    shared = draw(samplings())
    names = draw(
        st.lists(NAMES.map(str.strip).filter(bool), min_size=1, max_size=4, unique=True)
    )
    entries = []
    for name in names:
        wavelengths = shared if one_sampling else draw(samplings())
        values = draw(
            st.lists(REFLECTANCES, min_size=len(wavelengths), max_size=len(wavelengths))
        )
        statements = {key: draw(TEXTS) for key in STATEMENTS[1:]}
        entries.append(Entry(name, wavelengths, np.array(values), **statements))
    return Atlas(tuple(entries))


def check_round_trip(spectra, name):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name)
        write_atlas(spectra, path)
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore", UpliftWarning
            )  # values far from their neighbours
            found = read_atlas(path)
    for one, other in zip(found, spectra, strict=True):
        for key in ("wavelengths", "values"):
            assert getattr(one, key).tobytes() == getattr(other, key).tobytes()
        for key in ("name",) if name.endswith("csv") else STATEMENTS:
            assert getattr(one, key) == getattr(other, key)


@settings(max_examples=20)
@given(atlases(one_sampling=False))
def test_text_keeps_every_bit(spectra):
    check_round_trip(spectra, "atlas.txt")


@settings(max_examples=20)
@given(atlases(one_sampling=True))
@example(Atlas((Entry("%", [400, 700], [0.0, 1.0]),)))
@example(Atlas((Entry("STANDARDDEVIATION", [400, 700], [0.0, 1.0]),)))
def test_csv_keeps_every_bit(spectra):
    names = [entry.name for entry in spectra]
    stated = {quantity.kind for quantity in name_quantities(names) if quantity}
    stated -= {REFLECTANCE}
    if POWER in stated:  # of lamps, which are written, too
        return
    if stated or any(map(remark_scale, names)):
        with raises(OutputError, "output"), tempfile.TemporaryDirectory() as folder:
            write_atlas(spectra, f"{folder}/atlas.csv")
    else:
        check_round_trip(spectra, "atlas.csv")


def test_quoted_hash_is_a_name_and_not_a_comment(tmp_path):
    path = tmp_path / "atlas.csv"
    path.write_text(
        '# a comment\n"name",400,700\n  # another\n"#",0.1,0.2\n"# 1",0.3,0.4\n'
    )
    assert [entry.name for entry in read_atlas(path)] == ["#", "# 1"]


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
        WIDE.replace("550", "550 nm").replace("400", "400nm"),
        WIDE.replace("name", "").replace("red", '"red"'),
        TALL.replace("red", "1").replace("blue", "2"),
    ],
)
def test_layouts(read, text):
    spectra = read(text, "table.csv")
    assert spectra.names in (("red", "blue"), ("1", "2"))
    assert [entry.wavelengths.tolist() for entry in spectra.entries] == [
        [400, 550, 700]
    ] * 2
    assert [entry.values.tolist() for entry in spectra.entries] == [
        [0.1, 0.2, 0.9],
        [0.8, 0.3, 0.05],
    ]


@pytest.mark.parametrize(
    "text",
    ["name,400,700\nred,10,90\nblue,5,1.5\n", "nm,red,blue\n400,10,5\n700,90,1.5\n"],
)
def test_percent(read, text):
    with warns("values-in-percent") as caught:
        spectra = read(text)
    assert caught[0].entry == "red"
    assert "90" in caught[0].problem
    assert [entry.values.tolist() for entry in spectra.entries] == [
        [0.1, 0.9],
        [0.05, 0.015],
    ]


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        (WIDE.replace("0.2", "x"), 2, "atlas"),
        (WIDE.replace(",0.9", ""), 2, "missing-value"),
        (WIDE.replace("550", "x"), 1, "not-an-atlas"),
        ("400,0.1,0.2\n550,0.2,0.3\n700,0.9,0.3\n", 1, "atlas"),
        (WIDE.replace("700", "690"), 1, "atlas"),
        (WIDE.replace("blue", "red"), 3, "atlas"),
        (WIDE.replace("blue", '"bl\nue"'), 3, "atlas"),
        (WIDE.replace("blue", ""), 3, "atlas"),
        (WIDE.replace("0.2", "-0.2"), 2, "atlas"),
    ],
)
def test_faults_report_file_and_line(save, text, line, code):
    path = save(text, "table.csv")
    with raises(AtlasError, code) as caught:
        read_atlas(path)
    assert caught.value.where.startswith(f"{path}:{line}")


def test_endless_cells_and_numbers_raise(read):
    for text in ('name,"' + "x" * 200_000, WIDE + '"' + "x" * 200_000):
        with raises(AtlasError, "atlas"):
            read(text)
    with np.errstate(over="raise"), raises(AtlasError, "atlas"):
        read("name,400,550,700\nred,1e308,1e308,1e308\n")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("blue,30,1000,50", "got 1000 at 550 nm"),
        ("blue,30,,50", "missing value at 550 nm"),
        (
            "blue, dark,30,40,50",
            "got 5; put a name that contains the separator in quotes",
        ),
        ("blue,30,40", "missing value at 700 nm"),
    ],
)
def test_errors_of_a_row_show_what_is_in_the_file(read, row, words):
    with raises(AtlasError) as caught:
        read(f"name,400,550,700\nred,10,20,60\n{row}\ngrey,50,50,50\n")
    assert words in str(caught.value)


@pytest.mark.parametrize("name", ["grey.xlsx", "grey.png", "grey.spd"])
def test_an_atlas_is_written_as_text_or_a_table(tmp_path, name):
    with raises(OutputError, "output"):
        write_atlas(GREY, tmp_path / name)
    assert not (tmp_path / name).exists()
