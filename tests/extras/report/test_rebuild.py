"""Rebuilds of cubes from their recorded options and atlas files."""

import dataclasses
import shutil

import pytest

import uplift
from tests.helpers import quiet_build, raises, warns
from uplift.common.errors import CubeFileError
from uplift.cube.file import digest
from uplift.extras.report.rebuild import rebuild, recorded_atlas
from uplift.lookup.cube import Cube


@pytest.fixture
def home(tmp_path, monkeypatch):
    """An empty working folder, without shipped atlases."""
    monkeypatch.setattr("uplift.extras.report.rebuild.shipped_atlases", tuple)
    (tmp_path / "home").mkdir()
    monkeypatch.chdir(tmp_path / "home")
    return tmp_path / "home"


@pytest.fixture(scope="session")
def atlases(repository):
    return repository / "atlases"


@pytest.fixture(scope="session")
def tiny_cube(atlases):
    """Dim 3 of the ColorChecker, built in this run."""
    return quiet_build(atlases / "macbeth.txt", dim=3, coefficients=5)


def with_provenance(cube, **changes):
    provenance = {**cube.data.provenance, **changes}
    return Cube(dataclasses.replace(cube.data, provenance=provenance))


def with_options(cube, **options):
    return with_provenance(cube, options={**cube.data.provenance["options"], **options})


def same(cube, path, folders=()):
    """Whether a rebuild has the digest of the cube."""
    return digest(rebuild(cube, path, folders).data) == digest(cube.data)


def test_entries_outside_the_space_are_rebuilt(cyan_cube, atlases, home):
    again = rebuild(cyan_cube, home / "cube.uplift", [atlases])
    assert digest(again.data) == digest(cyan_cube.data)
    assert again.data.atlas.outside.names == ("cyan",)


def test_atlases_are_found_in_the_folder_atlases(tiny_cube, atlases, home):
    shutil.copytree(atlases, home / "atlases")
    assert same(tiny_cube, home / "cube.uplift")


@pytest.mark.parametrize(
    "name",
    ["{}/macbeth.txt", "../elsewhere/macbeth.txt", "macbeth.txt", "..", "", "a\0b"],
)
def test_a_recorded_name_opens_no_file_outside_the_folder_of_the_cube(
    tiny_cube, atlases, home, monkeypatch, name
):
    elsewhere = home.parent / "elsewhere"
    elsewhere.mkdir()
    shutil.copy(atlases / "macbeth.txt", elsewhere)
    monkeypatch.chdir(elsewhere)
    opened = []
    monkeypatch.setattr("uplift.extras.report.rebuild.read_document", opened.append)
    (source,) = tiny_cube.data.provenance["atlases"]
    named = {**source, "name": name.format(elsewhere)}
    with raises(CubeFileError, "atlas-not-found"):
        rebuild(with_provenance(tiny_cube, atlases=[named]), home / "cube.uplift")
    assert not opened


def test_a_recorded_observer_opens_no_file(tiny_cube, home, monkeypatch):
    opened = []
    monkeypatch.setattr("uplift.extras.colour.camera_file.read_camera", opened.append)
    cube = with_options(tiny_cube, space="camera", observer="/etc/camera.CSV")
    with raises(CubeFileError):
        rebuild(cube, home / "cube.uplift")
    assert not opened


def test_a_shipped_atlas_of_the_recorded_content_replaces_a_missing_file(
    tiny_cube, tmp_path
):
    path = tmp_path / "cube.uplift"
    assert same(tiny_cube, path)
    (source,) = tiny_cube.data.provenance["atlases"]
    renamed = with_provenance(tiny_cube, atlases=[{**source, "name": "mine.txt"}])
    with warns("shipped-atlas"):
        assert recorded_atlas(renamed.data, path).names[0] == "dark skin"
    unknown = with_provenance(tiny_cube, atlases=[{**source, "digest": "0" * 64}])
    with raises(CubeFileError, "atlas-not-found"):
        rebuild(unknown, path)


def test_the_first_file_of_the_recorded_name_decides(tiny_cube, atlases, tmp_path):
    """The recorded content in a later folder or among the shipped atlases does not hide
    that a file has changed.
    """
    text = (atlases / "macbeth.txt").read_text("utf-8")
    (tmp_path / "macbeth.txt").write_text(text + "\n", encoding="utf-8")
    path = tmp_path / "cube.uplift"
    for folders in ((), [tmp_path, atlases]):
        with raises(CubeFileError, "atlas-changed"):
            recorded_atlas(tiny_cube.data, path, folders)
    with warns("atlas-changed") as caught:
        rebuild(tiny_cube, path)
    assert str(tmp_path / "macbeth.txt") in caught[0].problem
    assert same(tiny_cube, path, [atlases])


def test_two_recorded_files_may_have_one_name(plain_cube, tmp_path):
    folders = [tmp_path / "first", tmp_path / "second"]
    for folder in folders:
        folder.mkdir()
        (folder / "mine.csv").write_text(f"name,400,700\n{folder.name},0.2,0.6\n")
    sources = uplift.read_atlas(*(folder / "mine.csv" for folder in folders)).sources
    recorded = [{"name": each.name, "digest": each.digest} for each in sources]
    data = with_provenance(plain_cube, atlases=recorded).data
    names = recorded_atlas(data, tmp_path / "cube.uplift", folders).names
    assert names == ("first", "second")


@pytest.mark.parametrize(
    "options",
    [
        {"progress": None},
        {"model": "spline"},
        {"lights": ["D65", "D66"]},
        {"threshold": {"a": 1}},
        {"solver": "custom"},
        {"dim": 400},
    ],
)
def test_unknown_recorded_options_are_reported_before_the_build(
    tiny_cube, atlases, monkeypatch, options
):
    monkeypatch.setattr(
        "uplift.pipeline.entries.fit_entries", lambda *_, **__: pytest.fail("fitted")
    )
    with raises(CubeFileError, "cube-file") as caught:
        rebuild(with_options(tiny_cube, **options), "cube.uplift", [atlases])
    assert caught.value.where == "cube.uplift"


def test_options_of_earlier_versions_are_accepted(tiny_cube, atlases):
    """The tolerance had another name, and entries as many coefficients as nodes."""
    options = dict(tiny_cube.data.provenance["options"])
    options["within"] = options.pop("auto_tolerance")
    del options["entry_coefficients"]
    earlier = with_provenance(tiny_cube, options=options, uplift="0.2.0")
    with warns("older-version") as caught:
        again = rebuild(earlier, "cube.uplift", [atlases])
    assert "0.2.0" in caught[0].problem
    assert again.entry_coefficient_count == again.coefficient_count


@pytest.mark.parametrize("provenance", [{}, {"options": {"dim": 8}}, {"atlases": []}])
def test_a_cube_without_provenance_cannot_be_rebuilt(small_cube, provenance):
    cube = Cube(dataclasses.replace(small_cube.data, provenance=provenance))
    with raises(CubeFileError, "cube-file"):
        rebuild(cube, "cube.uplift")
