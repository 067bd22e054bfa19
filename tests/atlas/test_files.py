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
from tests.helpers import raises
from uplift.atlas.atlas import Atlas, Entry, Header
from uplift.atlas.sources import read_atlas, write_atlas
from uplift.common.errors import AtlasError, OutputError, UpliftWarning
from uplift.extras.formats.quantities import POWER, REFLECTANCE, name_quantities
from uplift.extras.formats.statements import remark_scale

GREY = Atlas((Entry("grey", np.array([400.0, 700.0]), np.array([0.5, 0.25])),))
OTHER = Entry("other", np.array([380.0, 700.0]), np.array([0.5, 0.5]))
WIDE = "name,400,550,700\nred,0.1,0.2,0.9\nblue,0.8,0.3,0.05\n"


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("content", "code", "line", "words"),
    [
        ("", "atlas", None, ""),
        ("\ufeff\n\u2028", "atlas", None, ""),
        ("a\nb\0c", "atlas", None, ""),
        (PLAIN.encode("utf-16")[:-1], "atlas", None, ""),
        ("hello world\n", "not-an-atlas", None, ""),
        (",,,\n,,\n", "not-an-atlas", None, ""),
        (WIDE.replace("0.2", "x"), "atlas", 2, "'x'"),
        (WIDE.replace(",0.9", ""), "missing-value", 2, "missing value at 700 nm"),
        (WIDE.replace("0.3", ""), "missing-value", 3, "missing value at 550 nm"),
        (WIDE.replace("0.3", "1000"), "mixed-scales", 3, "1000, at 550 nm"),
        (WIDE.replace("blue", "blue, dark"), "atlas", 3, "the separator in quotes"),
        (WIDE.replace("blue", '"bl\nue"'), "atlas", 3, ""),
        (WIDE.replace("blue", ""), "atlas", 3, ""),
        (WIDE.replace("0.2", "-0.2"), "atlas", 2, "-0.2"),
        ('name,"' + "x" * 200_000, "atlas", None, ""),
        (WIDE + '"' + "x" * 200_000, "atlas", None, ""),
        ("name,400,550,700\nred,1e308,1e308,1e308\n", "atlas", None, ""),
    ],
)
def test_faults_report_file_line_and_what_is_there(save, content, code, line, words):
    path = save(content)
    with np.errstate(over="raise"), raises(AtlasError, code) as caught:
        read_atlas(path)
    assert caught.value.path == str(path)
    assert line in (None, caught.value.line)
    assert words in str(caught.value)


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


@pytest.mark.parametrize(
    ("entries", "name"),
    [
        (GREY, ""),
        (GREY, "file/out.txt"),
        (GREY, "x" * 300),
        (GREY, "grey.xlsx"),
        (GREY, "grey.spd"),
        ((), "out.txt"),
        ((*GREY, OTHER), "out.csv"),  # one row of wavelengths
    ],
)
def test_atlases_that_cannot_be_written_raise(tmp_path, entries, name):
    (tmp_path / "file").write_text("")
    with raises(OutputError, "output"):
        write_atlas(Atlas(tuple(entries)), tmp_path / name)
    assert os.listdir(tmp_path) == ["file"]


def test_content_determines_the_format(read):
    assert read(PLAIN, "atlas.csv").names == ("grey",)
    assert read("name,400,700\nblue,0.5,0.25\n", "atlas.ark").names == ("blue",)


def test_several_files_make_one_atlas_in_order(save):
    paths = [save(PLAIN.replace("grey", name), f"{name}.txt") for name in "cab"]
    spectra = read_atlas(*paths)
    assert spectra.names == ("c", "a", "b")
    assert [source.name for source in spectra.sources] == ["c.txt", "a.txt", "b.txt"]
    digest = hashlib.sha256(paths[0].read_bytes()).hexdigest()
    assert spectra.sources[0].digest == digest


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


TEXTS = st.text('ab" :{}-', max_size=12).map(lambda text: " ".join(text.split()))
NAMES = st.text(
    st.characters(codec="utf-8", exclude_categories=["Cc", "Zl", "Zp"]), max_size=20
).map(lambda text: text.strip() or "#")
STATEMENTS = ("description", "device", "measured_by", "date")


@st.composite
def atlases(draw):
    """Entries at regular wavelengths with any start and step, or at irregular ones."""
    start = draw(st.floats(300.0, 400.0))
    step = draw(st.floats(5.0, 100.0))
    wavelengths = start + step * np.arange(int(np.ceil((701.0 - start) / step)) + 1)
    if draw(st.booleans()):
        wavelengths = np.unique([*wavelengths[::2], 380.5, wavelengths[-1]])
    size = len(wavelengths)
    reflectances = st.lists(st.floats(-0.05, 1.0), min_size=size, max_size=size)
    entries = []
    for name in draw(st.lists(NAMES, min_size=1, max_size=4, unique=True)):
        statements = {key: draw(TEXTS) for key in STATEMENTS}
        values = np.array(draw(reflectances))
        entries.append(Entry(name, wavelengths, values, **statements))
    return Atlas(tuple(entries))


@settings(max_examples=20)
@pytest.mark.parametrize("suffix", ["txt", "csv"])
@given(spectra=atlases())
@example(spectra=Atlas((Entry("%", [400, 700], [0.0, 1.0]),)))
@example(spectra=Atlas((Entry("STANDARDDEVIATION", [400, 700], [0.0, 1.0]),)))
@example(spectra=Atlas((Entry("# 1", [400, 700], [0.0, 1.0], description='"a"'),)))
def test_files_keep_every_bit(suffix, spectra):
    """Tables keep names and samples, unless names state another quantity or scale."""
    names = [entry.name for entry in spectra]
    stated = {quantity.kind for quantity in name_quantities(names) if quantity}
    stated -= {REFLECTANCE}
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)  # values far from neighbours
        path = f"{folder}/atlas.{suffix}"
        if suffix == "csv" and POWER in stated:  # of lamps, which are written, too
            return
        if suffix == "csv" and (stated or any(map(remark_scale, names))):
            with raises(OutputError, "output"):
                write_atlas(spectra, path)
            return
        write_atlas(spectra, path, Header("greys", "(c) A. Person", "CC0"))
        found = read_atlas(path)
    for one, other in zip(found, spectra, strict=True):
        assert one.name == other.name
        assert one.wavelengths.tobytes() == other.wavelengths.tobytes()
        assert one.values.tobytes() == other.values.tobytes()
        for key in STATEMENTS if suffix == "txt" else ():
            assert getattr(one, key) == getattr(other, key)
    if suffix == "txt":
        assert found.sources[0].header == Header("greys", "(c) A. Person", "CC0")
