"""The files of atlases/ agree with tools/ship_atlases.py and the tables of colour-science."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

import uplift
from tests.atlas.atlas_texts import ATLASES
from tests.helpers import raises, warns
from uplift.atlas import read_atlas, shipped_atlases
from uplift.atlas.sources import find_atlas_file
from uplift.common.errors import AtlasError

SHIPPED = {
    "babelcolor.txt": (24, 380, 730, 10),
    "cie2017.txt": (99, 380, 780, 5),
    "macbeth.txt": (24, 380, 780, 5),
    "pmc.txt": (30, 400, 700, 10),
    "rawtoaces.txt": (190, 380, 780, 5),
    "tcs.txt": (14, 360, 830, 5),
    "vs.txt": (15, 360, 830, 5),
}


@pytest.fixture
def empty_folder(tmp_path, monkeypatch):
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


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


def test_tool_writes_the_same_bytes(tmp_path):
    tool = runpy.run_path(str(ATLASES.parent / "tools" / "ship_atlases.py"))
    tool["main"](tmp_path)
    for file in SHIPPED:
        assert (tmp_path / file).read_bytes() == (ATLASES / file).read_bytes()


def test_list_states_name_content_source_licence_and_entries():
    atlases = shipped_atlases()
    assert [atlas.path.name for atlas in atlases] == sorted(SHIPPED)
    for atlas in atlases:
        count = SHIPPED[atlas.path.name][0]
        header = read_atlas(ATLASES / atlas.path.name).sources[0].header
        assert (atlas.name, atlas.entries) == (atlas.path.stem, count)
        assert (atlas.content, atlas.source, atlas.licence) == (header.content, header.copyright, header.licence)


def test_bare_name_reads_the_shipped_atlas_from_an_empty_folder(empty_folder):
    assert read_atlas("macbeth").sources == read_atlas(ATLASES / "macbeth.txt").sources


def test_name_of_a_missing_file_reads_the_shipped_atlas_with_a_warning(empty_folder):
    with warns("shipped-atlas") as caught:
        atlas = read_atlas("macbeth.txt", "pmc")
    assert caught[0].where == "macbeth.txt"
    assert [source.name for source in atlas.sources] == ["macbeth.txt", "pmc.txt"]


@pytest.mark.parametrize("name", ["macbeth", "macbeth.txt"])
def test_existing_file_takes_precedence(empty_folder, name):
    (empty_folder / name).write_text("name,380,780\nwhite,1,1\n")
    assert read_atlas(name).names == ("white",)


@pytest.mark.parametrize("path", ["macbet", "Macbeth.txt", "atlases/macbeth.txt"])
def test_hint_names_the_nearest_shipped_atlas(empty_folder, path):
    with raises(AtlasError, "file-not-found") as caught:
        read_atlas(path)
    assert caught.value.where == path
    assert "'macbeth'" in caught.value.hint


def test_cube_records_the_file_of_a_shipped_atlas(empty_folder):
    with pytest.warns(uplift.UpliftWarning):
        cube = uplift.build("macbeth", dim=3, coefficients=4)
    (source,) = read_atlas(ATLASES / "macbeth.txt").sources
    assert cube.data.provenance["atlases"] == [{"name": source.name, "digest": source.digest}]


def test_relative_paths_start_in_the_folder(empty_folder):
    (empty_folder / "macbeth.txt").write_text("name,380,780\nwhite,1,1\n")
    assert find_atlas_file("macbeth", empty_folder) == shipped_atlases()[2].path
    assert Path(find_atlas_file("macbeth.txt", empty_folder)) == empty_folder / "macbeth.txt"
