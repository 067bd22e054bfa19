"""The files of atlases/ agree with tools/ship_atlases.py and the tables of
colour-science.
"""

import os
import runpy

import pytest

from tests.atlas.atlas_texts import ATLASES
from tests.helpers import raises, warns
from uplift.atlas.sources import read_atlas, shipped_atlases
from uplift.common.errors import AtlasError


@pytest.fixture
def empty_folder(tmp_path, monkeypatch):
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("shipped", shipped_atlases(), ids=lambda shipped: shipped.name)
def test_entries_header_and_readme(shipped):
    spectra = read_atlas(ATLASES / shipped.path.name)
    assert (shipped.name, shipped.entries, spectra.skipped) == (
        shipped.path.stem,
        len(spectra),
        (),
    )
    start, *_, end = next(iter(spectra)).wavelengths
    header = spectra.sources[0].header
    assert "colour-science" in header.copyright
    assert "BSD-3-Clause" in header.licence
    assert (shipped.content, shipped.source, shipped.licence) == (
        header.content,
        header.copyright,
        header.licence,
    )
    readme = (ATLASES / "README.md").read_text("utf-8")
    assert (
        f"| `{shipped.path.name}` | {len(spectra)} | {start:.0f}–{end:.0f}, " in readme
    )


def test_tool_writes_the_same_bytes(tmp_path):
    tool = runpy.run_path(str(ATLASES.parent / "tools" / "ship_atlases.py"))
    tool["main"](tmp_path)
    files = [path.name for path in ATLASES.glob("*.txt")]
    assert sorted(files) == sorted(os.listdir(tmp_path))
    for file in files:
        assert (tmp_path / file).read_bytes() == (ATLASES / file).read_bytes()


@pytest.mark.parametrize(
    "name", ["macbeth.txt", "./macbeth.txt", "Macbeth.txt", "MACBETH"]
)
def test_names_of_missing_files_read_the_shipped_atlas(empty_folder, name):
    with warns("shipped-atlas") as caught:
        atlas = read_atlas(name, "pmc")
    assert caught[0].where == name
    assert atlas.sources[0] == read_atlas(ATLASES / "macbeth.txt").sources[0]
    assert [source.name for source in atlas.sources] == ["macbeth.txt", "pmc.txt"]


@pytest.mark.parametrize("name", ["macbeth", "macbeth.txt"])
def test_existing_file_takes_precedence(empty_folder, name):
    (empty_folder / name).write_text("name,380,780\nwhite,1,1\n")
    assert read_atlas(name).names == ("white",)


@pytest.mark.parametrize(
    "path", ["macbet", "Macbet.txt", "atlases/macbeth.txt", "atlases/Macbeth.txt"]
)
def test_hint_names_the_nearest_shipped_atlas(empty_folder, path):
    with raises(AtlasError, "file-not-found") as caught:
        read_atlas(path)
    assert caught.value.where == path
    assert "'macbeth'" in caught.value.hint
