"""Files in general: unreadable ones, sources, and round trips that keep every bit."""

from __future__ import annotations

import hashlib
import os
import tempfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.atlas.atlas_texts import PLAIN
from tests.helpers import raises
from uplift.atlas import Atlas, Entry, Header, read_atlas, write_atlas
from uplift.common.errors import AtlasError, OutputError

GREY = Atlas((Entry("grey", np.array([400.0, 700.0]), np.array([0.5, 0.25])),))


@pytest.mark.parametrize(
    ("content", "code"),
    [
        ("", "atlas"),
        (" \n\t\n", "atlas"),
        ("\ufeff\n\u2028", "atlas"),
        ("a\nb\0c", "atlas"),
        (PLAIN.encode("utf-16")[:-1], "atlas"),
        ("hello world\n", "not-an-atlas"),
        ("hello\nworld\n", "not-an-atlas"),
        (",,,\n,,\n", "not-an-atlas"),
    ],
)
def test_files_without_an_atlas_raise(save, content, code):
    path = save(content)
    with raises(AtlasError, code) as caught:
        read_atlas(path)
    assert caught.value.where.startswith(str(path))


def test_unreadable_files_raise(tmp_path):
    for path, code, reason in [
        (tmp_path / "none.txt", "file-not-found", "no such file"),
        (tmp_path, "not-a-regular-file", "a folder"),
        ("/dev/zero", "not-a-regular-file", "a device"),
        ("a\0b", "file-unreadable", "null"),
    ]:
        with raises(AtlasError, code) as caught:
            read_atlas(path)
        assert reason in caught.value.problem


@pytest.mark.skipif(os.name == "nt" or not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root reads all")
def test_file_without_permission_raises(save):
    path = save(PLAIN)
    path.chmod(0)
    with raises(AtlasError, "file-unreadable"):
        read_atlas(path)


def test_content_determines_the_format(save):
    assert read_atlas(save(PLAIN, "atlas.csv")).names == ("grey",)
    assert read_atlas(save("name,400,700\nblue,0.5,0.25\n", "atlas.ark")).names == ("blue",)


def test_source_has_the_digest_of_the_bytes(save):
    (source,) = read_atlas(save(PLAIN.replace("\n", "\r\n"))).sources
    assert source.name == "atlas.txt"
    assert source.digest == hashlib.sha256(PLAIN.replace("\n", "\r\n").encode()).hexdigest()


def test_several_files_make_one_atlas_in_order(save):
    paths = [save(PLAIN.replace("grey", name), f"{name}.txt") for name in "cab"]
    spectra = read_atlas(*paths)
    assert spectra.names == ("c", "a", "b")
    assert len(spectra) == 3
    assert [source.name for source in spectra.sources] == ["c.txt", "a.txt", "b.txt"]
    assert len(read_atlas()) == 0


def test_duplicate_name_reports_both_locations(save):
    first, second = save(PLAIN, "a.txt"), save(PLAIN, "b.txt")
    with raises(AtlasError, "atlas") as caught:
        read_atlas(first, second)
    assert caught.value.where == f"{second}:1: entry 'grey'"
    assert f"{first}:1" in caught.value.problem
    twice = save(PLAIN + PLAIN, "c.txt")
    with raises(AtlasError, "atlas") as caught:
        read_atlas(twice)
    assert caught.value.where == f"{twice}:19: entry 'grey'"
    assert f"{twice}:1" in caught.value.problem


def test_header_survives_a_round_trip(tmp_path):
    header = Header("greys", "(c) A. Person", "CC0")
    write_atlas(GREY, tmp_path / "a.txt", header)
    found = read_atlas(tmp_path / "a.txt")
    assert found.sources[0].header == header
    write_atlas(found, tmp_path / "b.txt")
    assert (tmp_path / "b.txt").read_bytes() == (tmp_path / "a.txt").read_bytes()


def test_paths_that_cannot_be_written_raise(tmp_path):
    (tmp_path / "file").write_text("")
    for path, code in (
        (tmp_path, "not-a-regular-file"),
        (tmp_path / "no" / "out.txt", "output"),
        (tmp_path / "file" / "out.txt", "output"),
        (tmp_path / ("x" * 300), "output"),
    ):
        with raises(OutputError, code):
            write_atlas(GREY, path)
    assert os.listdir(tmp_path) == ["file"]


def test_empty_atlas_cannot_be_written(tmp_path):
    with raises(OutputError, "output"):
        write_atlas(Atlas(), tmp_path / "out.txt")


NAMES = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Zl", "Zp"]), min_size=1, max_size=20)
TEXTS = st.text('ab" :{}-', max_size=12).map(lambda text: " ".join(text.split()))
REFLECTANCES = st.floats(-0.05, 2.0)
INNER = st.floats(1.0, 2000.0).map(lambda nm: round(nm, 4))


@st.composite
def samplings(draw):
    """Irregular wavelengths, or regular ones with any start and step that cover the visible range."""
    if draw(st.booleans()):
        return np.unique([400.0, 700.0, *draw(st.lists(INNER, max_size=8))])
    start, step = draw(st.floats(300.0, 400.0)), draw(st.floats(5.0, 100.0))
    return start + step * np.arange(int(np.ceil((701.0 - start) / step)) + 1)


@st.composite
def atlases(draw, one_sampling):
    shared = draw(samplings())
    names = draw(st.lists(NAMES.map(str.strip).filter(bool), min_size=1, max_size=4, unique=True))
    entries = []
    for name in names:
        wavelengths = shared if one_sampling else draw(samplings())
        values = draw(st.lists(REFLECTANCES, min_size=len(wavelengths), max_size=len(wavelengths)))
        entries.append(Entry(name, wavelengths, np.array(values), *(draw(TEXTS) for _ in range(5))))
    return Atlas(tuple(entries))


def round_trip(spectra, name):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name)
        write_atlas(spectra, path)
        return read_atlas(path)


def check_same(found, spectra):
    assert found.names == spectra.names
    for one, other in zip(found.entries, spectra.entries, strict=True):
        assert one.wavelengths.tobytes() == other.wavelengths.tobytes()
        assert one.values.tobytes() == other.values.tobytes()


@settings(max_examples=60)
@given(atlases(one_sampling=False))
def test_text(spectra):
    found = round_trip(spectra, "atlas.txt")
    check_same(found, spectra)
    for one, other in zip(found.entries, spectra.entries, strict=True):
        for key in ("description", "additional_description", "device", "measured_by", "date"):
            assert getattr(one, key) == getattr(other, key)


@settings(max_examples=60)
@given(atlases(one_sampling=True))
def test_csv(spectra):
    check_same(round_trip(spectra, "atlas.csv"), spectra)


def test_quoted_hash_is_a_name_and_not_a_comment(tmp_path):
    path = tmp_path / "atlas.csv"
    path.write_text('# a comment\n"name",400,700\n  # another\n"#",0.1,0.2\n"# 1",0.3,0.4\n')
    assert [entry.name for entry in read_atlas(path)] == ["#", "# 1"]
