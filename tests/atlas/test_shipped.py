"""The files of atlases/ agree with tools/ship_atlases.py and the tables of colour-science."""

import runpy

import pytest

from tests.atlas.atlas_texts import ATLASES
from tests.helpers import raises, warns
from uplift.atlas import read_atlas, shipped_atlases
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


@pytest.mark.parametrize("shipped", shipped_atlases(), ids=lambda shipped: shipped.name)
def test_entries_header_and_readme(shipped):
    count, start, end, step = SHIPPED[shipped.path.name]
    spectra = read_atlas(ATLASES / shipped.path.name)
    assert (shipped.name, shipped.entries, len(spectra), spectra.skipped) == (shipped.path.stem, count, count, ())
    for entry in spectra:
        assert (entry.wavelengths[0], entry.wavelengths[-1], entry.step) == (start, end, step)
    header = spectra.sources[0].header
    assert "colour-science" in header.copyright
    assert "BSD-3-Clause" in header.licence
    assert (shipped.content, shipped.source, shipped.licence) == (header.content, header.copyright, header.licence)
    readme = (ATLASES / "README.md").read_text(encoding="utf-8")
    assert f"| `{shipped.path.name}` | {count} | {start}–{end}, {step} |" in readme


def test_tool_writes_the_same_bytes(tmp_path):
    tool = runpy.run_path(str(ATLASES.parent / "tools" / "ship_atlases.py"))
    tool["main"](tmp_path)
    assert sorted(SHIPPED) == sorted(path.name for path in ATLASES.glob("*.txt"))
    for file in SHIPPED:
        assert (tmp_path / file).read_bytes() == (ATLASES / file).read_bytes()


@pytest.mark.parametrize("name", ["macbeth.txt", "./macbeth.txt", "Macbeth.txt", "MACBETH"])
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


@pytest.mark.parametrize("path", ["macbet", "Macbet.txt", "atlases/macbeth.txt", "atlases/Macbeth.txt"])
def test_hint_names_the_nearest_shipped_atlas(empty_folder, path):
    with raises(AtlasError, "file-not-found") as caught:
        read_atlas(path)
    assert caught.value.where == path
    assert "'macbeth'" in caught.value.hint
