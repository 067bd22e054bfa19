"""Cubes made again from what they recorded of their making."""

from __future__ import annotations

import dataclasses
import itertools
import shutil

import numpy as np
import pytest

import uplift
from tests.helpers import with_points
from uplift.common.errors import CubeFileError
from uplift.cube import digest
from uplift.lookup import Cube
from uplift.pipeline.rebuild import rebuild
from uplift.report.regression import compare_rebuilt


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A working folder that holds nothing."""
    (tmp_path / "home").mkdir()
    monkeypatch.chdir(tmp_path / "home")
    return tmp_path / "home"


@pytest.fixture(scope="session")
def tiny_cube(repository):
    """Dim 3 of the ColorChecker, built in this run."""
    with pytest.warns(uplift.UpliftWarning):
        return uplift.build(repository / "atlases" / "macbeth.txt", dim=3, coefficients=5)


def with_provenance(cube, **changes):
    return Cube(dataclasses.replace(cube.data, provenance={**cube.data.provenance, **changes}))


def with_option(cube, **options):
    return with_provenance(cube, options={**cube.data.provenance["options"], **options})


def refused(cube, path, folders=()):
    """The message with which a rebuilding is refused: one line, the cube first, a hint last."""
    with pytest.raises(CubeFileError) as caught:
        rebuild(cube, path, folders)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    assert caught.value.hint
    return message


def test_the_stored_cube_equals_its_rebuilding(small_cube, repository, home):
    path = repository / "cubes" / "moments-8-macbeth.uplift"
    rounds = []
    again = rebuild(small_cube, path, progress=rounds.append)
    assert compare_rebuilt(path, small_cube.data, again.data).failures == ()
    assert rounds
    assert again.data.provenance["options"] == small_cube.data.provenance["options"]


def test_a_nudged_cube_does_not(tiny_cube, repository):
    coefficients = tiny_cube.data.points.coefficients.copy()
    coefficients[13, 2] += 1e-3
    nudged = Cube(with_points(tiny_cube.data, coefficients=coefficients))
    again = rebuild(nudged, "cube.uplift", [repository / "atlases"])
    assert "spectra_max" in compare_rebuilt("cube.uplift", nudged.data, again.data).failures
    assert digest(again.data) == digest(tiny_cube.data)


def test_rebuilding_is_silent_about_what_the_first_build_said(tiny_cube, repository):
    rebuild(tiny_cube, "cube.uplift", [repository / "atlases"])  # warnings are errors here


@pytest.mark.parametrize("place", [".", "atlases", "../atlases", "../elsewhere", "../elsewhere/atlases"])
def test_atlases_are_found_beside_the_cube_here_and_in_folders_of_theirs(tiny_cube, repository, home, place):
    (home / place).mkdir(parents=True, exist_ok=True)
    shutil.copy(repository / "atlases" / "macbeth.txt", home / place)
    cube = home.parent / "elsewhere" / "cube.uplift"
    assert digest(rebuild(tiny_cube, cube).data) == digest(tiny_cube.data)


def test_a_missing_atlas_is_named_with_a_remedy(tiny_cube, home):
    message = refused(tiny_cube, home / "cube.uplift", [home / "none"])
    assert "its atlas 'macbeth.txt' is not to be found; name the folder with --atlas-dir" in message


def test_an_atlas_of_the_same_name_but_other_content_is_refused(tiny_cube, repository, home):
    text = (repository / "atlases" / "macbeth.txt").read_text(encoding="utf-8")
    (home / "macbeth.txt").write_text(text + "\n", encoding="utf-8")
    message = refused(tiny_cube, home / "cube.uplift")
    assert f"its atlas 'macbeth.txt' has changed ({home / 'macbeth.txt'}); name the folder" in message


def test_a_changed_atlas_does_not_hide_the_true_one(tiny_cube, repository, home):
    (home / "macbeth.txt").write_text("Entry ID: other\n", encoding="utf-8")
    again = rebuild(tiny_cube, home / "cube.uplift", [home, repository / "atlases"])
    assert digest(again.data) == digest(tiny_cube.data)


@pytest.mark.parametrize(
    "options",
    [
        {"kriging": True},
        {"progress": None},
        {"atlas": None},
        {"model": "spline"},
        {"illuminant": "D66"},
        {"lights": ["D65", "D66"]},
        {"space": "sRGBB"},
        {"axis": "cubic"},
        {"dim": 1},
        {"dim": "eight"},
        {"coefficients": 99},
    ],
)
def test_options_unknown_here_are_told(tiny_cube, repository, options):
    message = refused(with_option(tiny_cube, **options), "cube.uplift", [repository / "atlases"])
    assert "was made with options unknown here (" in message
    assert message.endswith("; build it anew")


@pytest.mark.parametrize(
    "provenance",
    [
        {},
        {"options": {}},
        {"options": "dim 8"},
        {"options": None, "atlases": []},
        {"options": {"lights": 5}, "atlases": []},
        {"options": {"lights": []}, "atlases": [{}]},
        {"options": {"lights": []}, "atlases": ["macbeth.txt"]},
        {"options": {"lights": []}, "atlases": None},
    ],
)
def test_a_cube_that_does_not_say_how_it_was_made_cannot_be_made_again(small_cube, provenance):
    silent = Cube(dataclasses.replace(small_cube.data, provenance=provenance))
    assert "does not say how it was made; build it anew" in refused(silent, "cube.uplift")


def test_other_options_make_another_cube(tiny_cube, repository):
    other = rebuild(with_option(tiny_cube, axis="linear"), "cube.uplift", [repository / "atlases"])
    assert not np.array_equal(other.data.lattice.nodes, tiny_cube.data.lattice.nodes)


def test_there_are_stored_cubes_of_both_models_and_sizes_with_and_without_an_atlas(repository):
    cubes = [uplift.load(path).data for path in (repository / "cubes").glob("*.uplift")]
    kinds = {(cube.model.name, cube.lattice.dim, bool(cube.atlas.names)) for cube in cubes}
    expected = itertools.product(("moments", "sigmoid"), (8, 16), (True, False))
    assert kinds == set(expected)


def test_the_package_s_own_cube_is_one_of_them(repository):
    own = (repository / "uplift" / "lookup" / "default.uplift").read_bytes()
    assert own == (repository / "cubes" / "moments-16.uplift").read_bytes()
