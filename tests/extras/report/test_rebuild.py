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
def tiny_cube(repository):
    """Dim 3 of the ColorChecker, built in this run."""
    with pytest.warns(uplift.UpliftWarning):
        return uplift.build(
            repository / "atlases" / "macbeth.txt", dim=3, coefficients=5
        )


def with_provenance(cube, **changes):
    return Cube(
        dataclasses.replace(cube.data, provenance={**cube.data.provenance, **changes})
    )


def with_option(cube, **options):
    return with_provenance(cube, options={**cube.data.provenance["options"], **options})


def rebuild_error(code, cube, path, folders=()):
    """The error of a rebuild: one line, located at the cube, with a hint."""
    with raises(CubeFileError, code) as caught:
        rebuild(cube, path, folders)
    assert caught.value.where == str(path)
    assert "\n" not in str(caught.value)
    assert caught.value.hint
    return caught.value


def test_entries_outside_the_space_are_rebuilt(cyan_cube, repository, home):
    again = rebuild(cyan_cube, home / "cube.uplift", [repository / "atlases"])
    assert digest(again.data) == digest(cyan_cube.data)
    assert again.data.atlas.outside.names == ("cyan",)


@pytest.mark.parametrize("place", [".", "atlases"])
def test_atlases_are_found_next_to_the_cube_and_in_the_folder_atlases(
    tiny_cube, repository, home, place
):
    folder = home.parent / "elsewhere"
    (folder / place).mkdir(parents=True, exist_ok=True)
    shutil.copy(repository / "atlases" / "macbeth.txt", folder / place)
    assert digest(rebuild(tiny_cube, folder / "cube.uplift").data) == digest(
        tiny_cube.data
    )


@pytest.mark.parametrize(
    "name",
    ["{}/macbeth.txt", "../elsewhere/macbeth.txt", "macbeth.txt", "..", "", "a\0b"],
)
def test_a_recorded_name_opens_no_file_outside_the_folder_of_the_cube(
    tiny_cube, repository, home, monkeypatch, name
):
    elsewhere = home.parent / "elsewhere"
    elsewhere.mkdir()
    shutil.copy(repository / "atlases" / "macbeth.txt", elsewhere)
    monkeypatch.chdir(elsewhere)
    opened = []
    monkeypatch.setattr("uplift.extras.report.rebuild.read_document", opened.append)
    digest = tiny_cube.data.provenance["atlases"][0]["digest"]
    cube = with_provenance(
        tiny_cube, atlases=[{"name": name.format(elsewhere), "digest": digest}]
    )
    rebuild_error("atlas-not-found", cube, home / "cube.uplift")
    assert not opened


def test_a_recorded_observer_opens_no_file(tiny_cube, home, monkeypatch):
    opened = []
    monkeypatch.setattr("uplift.extras.colour.camera_file.read_camera", opened.append)
    options = {
        **tiny_cube.data.provenance["options"],
        "space": "camera",
        "observer": "/etc/camera.CSV",
    }
    with raises(CubeFileError):
        rebuild(with_provenance(tiny_cube, options=options), home / "cube.uplift")
    assert not opened


def test_a_shipped_atlas_of_the_recorded_content_replaces_a_missing_file(
    tiny_cube, tmp_path
):
    assert digest(rebuild(tiny_cube, tmp_path / "cube.uplift").data) == digest(
        tiny_cube.data
    )
    (source,) = tiny_cube.data.provenance["atlases"]
    renamed = with_provenance(tiny_cube, atlases=[{**source, "name": "mine.txt"}])
    with warns("shipped-atlas"):
        assert (
            recorded_atlas(renamed.data, tmp_path / "cube.uplift").names[0]
            == "dark skin"
        )
    unknown = with_provenance(tiny_cube, atlases=[{**source, "digest": "0" * 64}])
    rebuild_error("atlas-not-found", unknown, tmp_path / "cube.uplift")


def test_the_first_file_of_the_recorded_name_decides(tiny_cube, repository, tmp_path):
    """The recorded content in a later folder or among the shipped atlases does not hide
    that a file has changed.
    """
    text = (repository / "atlases" / "macbeth.txt").read_text("utf-8")
    (tmp_path / "macbeth.txt").write_text(text + "\n", encoding="utf-8")
    path = tmp_path / "cube.uplift"
    folder = repository / "atlases"
    for folders in ((), [tmp_path, folder]):
        with warns("atlas-changed") as caught:
            rebuild(tiny_cube, path, folders)
        assert str(tmp_path / "macbeth.txt") in caught[0].problem
        with raises(CubeFileError, "atlas-changed"):
            recorded_atlas(tiny_cube.data, path, folders)
    assert digest(rebuild(tiny_cube, path, [folder]).data) == digest(tiny_cube.data)


def test_a_cube_of_an_earlier_version_is_noted(tiny_cube, repository):
    with warns("older-version") as caught:
        rebuild(
            with_provenance(tiny_cube, uplift="0.2.0"),
            "cube.uplift",
            [repository / "atlases"],
        )
    assert "0.2.0" in caught[0].problem


def test_two_recorded_files_may_have_one_name(tmp_path):
    folders = [tmp_path / "first", tmp_path / "second"]
    for folder, value in zip(folders, (0.2, 0.6), strict=True):
        folder.mkdir()
        (folder / "mine.csv").write_text(
            f"name,400,700\n{folder.name},{value},{value}\n", encoding="utf-8"
        )
    cube = quiet_build(
        [folder / "mine.csv" for folder in folders], dim=3, coefficients=4
    )
    assert recorded_atlas(cube.data, tmp_path / "cube.uplift", folders).names == (
        "first",
        "second",
    )


OPTIONS = [
    {"progress": None},
    {"model": "spline"},
    {"lights": ["D65", "D66"]},
    {"lights": [3]},
    {"dim": 1},
]


@pytest.mark.parametrize(
    "options",
    [*OPTIONS, {"threshold": {"a": 1}}, {"coefficients": 99}, {"solver": "custom"}],
)
def test_unknown_recorded_options_are_reported(tiny_cube, repository, options):
    cube = with_option(tiny_cube, **options)
    rebuild_error("cube-file", cube, "cube.uplift", [repository / "atlases"])


def test_options_of_earlier_versions_are_accepted(tiny_cube, repository):
    """The tolerance had another name, and entries as many coefficients as nodes."""
    options = dict(tiny_cube.data.provenance["options"])
    options["within"] = options.pop("auto_tolerance")
    again = rebuild(
        with_provenance(tiny_cube, options=options),
        "cube.uplift",
        [repository / "atlases"],
    )
    assert digest(again.data) == digest(tiny_cube.data)
    del options["entry_coefficients"]
    again = rebuild(
        with_provenance(tiny_cube, options=options),
        "cube.uplift",
        [repository / "atlases"],
    )
    assert again.entry_coefficient_count == again.coefficient_count


@pytest.mark.parametrize(
    "provenance", [{}, {"options": {}}, {"options": {"dim": 8}}, {"atlases": []}]
)
def test_a_cube_without_provenance_cannot_be_rebuilt(small_cube, provenance):
    cube = Cube(dataclasses.replace(small_cube.data, provenance=provenance))
    rebuild_error("cube-file", cube, "cube.uplift")


def test_another_recorded_dim_is_reported_before_the_build(tiny_cube, monkeypatch):
    monkeypatch.setattr(
        "uplift.pipeline.entries.fit_entries", lambda *_, **__: pytest.fail("fitted")
    )
    rebuild_error("cube-file", with_option(tiny_cube, dim=400), "cube.uplift")
