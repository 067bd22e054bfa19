"""Files in general: unreadable files, sources, and writing."""

from __future__ import annotations

import hashlib
import os

import numpy as np
import pytest

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
    assert (
        (tmp_path / "a.txt")
        .read_text()
        .startswith(
            "ART measurement archive version 1.1\n\nArchive content: greys\n"
            "Archive copyright: (c) A. Person\nArchive license: CC0\n\nEntry ID:   grey\n"
        )
    )
    write_atlas(read_atlas(tmp_path / "a.txt"), tmp_path / "b.txt")
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
