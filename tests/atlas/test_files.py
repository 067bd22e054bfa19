"""Files that are no atlas at all, and writing."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys

import numpy as np
import pytest

from tests.atlas.atlas_texts import PLAIN
from uplift.atlas import Atlas, Entry, Header, read_atlas, write_atlas
from uplift.common.errors import AtlasError, OutputError

GREY = Atlas((Entry("grey", np.array([400.0, 700.0]), np.array([0.5, 0.25])),))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", ": the file is empty; name a file that holds atlas entries"),
        (" \n\t\n", ": the file is empty; name a file that holds atlas entries"),
        ("\ufeff\n\u2028", ": the file is empty; name a file that holds atlas entries"),
        ("a\nb\0c", ":2: binary data (a NUL byte), no text; save the atlas as UTF-8 text"),
        (PLAIN.encode("utf-16"), ":1: binary data (a NUL byte), no text; save the atlas as UTF-8 text"),
        (
            "hello world\n",
            ":1: neither an atlas text (no 'Entry ID') nor a table of reflectances; write a header",
        ),
        (
            "hello\nworld\n",
            ":1: neither an atlas text (no 'Entry ID') nor a table of reflectances; write a header",
        ),
        (
            ",,,\n,,\n",
            ":1: neither an atlas text (no 'Entry ID') nor a table of reflectances; write a header",
        ),
    ],
)
def test_no_atlas(save, content, message):
    path = save(content)
    with pytest.raises(AtlasError) as caught:
        read_atlas(path)
    assert str(caught.value).startswith(f"{path}{message}")


def test_files_that_cannot_be_read(tmp_path):
    for path, reason in [
        (tmp_path / "none.txt", "no such file"),
        (tmp_path, "is a directory"),
        ("a\0b", "null"),
    ]:
        with pytest.raises(AtlasError, match=f"cannot be read: .*{reason}.*; name an atlas file"):
            read_atlas(path)


@pytest.mark.skipif(
    os.name == "nt" or not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root reads all"
)
def test_forbidden_file(save):
    path = save(PLAIN)
    path.chmod(0)
    with pytest.raises(AtlasError, match="cannot be read: permission denied; name an atlas file"):
        read_atlas(path)


def test_content_decides_on_the_format_not_the_name(save):
    assert read_atlas(save(PLAIN, "atlas.csv")).names == ("grey",)
    assert read_atlas(save("name,400,700\nblue,0.5,0.25\n", "atlas.ark")).names == ("blue",)


def test_sources_name_the_bytes(save):
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


def test_one_name_twice_names_both_places(save):
    first, second = save(PLAIN, "a.txt"), save(PLAIN, "b.txt")
    with pytest.raises(AtlasError) as caught:
        read_atlas(first, second)
    assert str(caught.value) == (
        f"{second}:1: entry 'grey': the name is taken: first used at {first}:1; "
        "rename or remove one of the two"
    )
    twice = save(PLAIN + PLAIN, "c.txt")
    with pytest.raises(AtlasError, match=rf"c\.txt:19: entry 'grey': .* first used at {twice}:1; rename"):
        read_atlas(twice)


def test_writing_replaces_whole_files_and_leaves_no_other(tmp_path):
    path = tmp_path / "out.txt"
    path.write_text("old")
    write_atlas(GREY, path)
    assert read_atlas(path).names == ("grey",)
    assert os.listdir(tmp_path) == ["out.txt"]


def test_the_header_is_written_and_handed_on(tmp_path):
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


def test_an_unstated_header_stays_unstated(tmp_path):
    write_atlas(GREY, tmp_path / "a.txt")
    assert read_atlas(tmp_path / "a.txt").sources[0].header == Header()


def test_places_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    for path in (
        tmp_path,
        tmp_path / "no" / "out.txt",
        tmp_path / "file" / "out.txt",
        tmp_path / ("x" * 300),
    ):
        with pytest.raises(
            OutputError,
            match=r"is no regular file|there is no folder|cannot be written: .*; choose another name",
        ):
            write_atlas(GREY, path)
    assert os.listdir(tmp_path) == ["file"]


def test_nothing_to_write(tmp_path):
    with pytest.raises(OutputError, match="no entries to write"):
        write_atlas(Atlas(), tmp_path / "out.txt")


def test_importing_costs_neither_scipy_nor_colour_nor_jax():
    code = "import sys, uplift.atlas; print({'scipy', 'colour', 'jax', 'uplift.colorimetry.observer'} & set(sys.modules))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "set()"
