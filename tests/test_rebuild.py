"""A cube is made again from what it recorded, or it is said why not."""

from __future__ import annotations

import dataclasses
import shutil

import numpy as np
import pytest

from uplift.errors import CubeFileError
from uplift.lookup import Cube, load
from uplift.rebuild import rebuild

from .conftest import MACBETH, ROOT

STORED = sorted((ROOT / "cubes").glob("*.uplift"))


def told(cube, **changes):
    provenance = {**cube.data.provenance, **changes}
    return Cube(dataclasses.replace(cube.data, provenance=provenance))


def test_there_are_stored_cubes_of_both_models_and_sizes_with_and_without_an_atlas():
    cubes = [load(path).data for path in STORED]
    kinds = {(cube.model.name, cube.lattice.dim, bool(cube.atlas.names)) for cube in cubes}
    assert kinds == {
        (model, dim, atlas) for model in ("moments", "sigmoid") for dim in (8, 16) for atlas in (True, False)
    }


def test_the_package_s_own_cube_is_one_of_them():
    own = (ROOT / "uplift" / "lookup" / "default.uplift").read_bytes()
    assert own == (ROOT / "cubes" / "moments-16.uplift").read_bytes()


def test_the_rebuilding_answers_as_the_stored_cube(small_cube):
    again = rebuild(small_cube, ROOT / "cubes" / "moments-8-macbeth.uplift")
    np.testing.assert_allclose(again.data.coefficients, small_cube.data.coefficients, atol=1e-6)
    assert again.data.provenance == small_cube.data.provenance


def test_the_atlas_is_found_in_a_named_folder(small_cube, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CubeFileError, match=r"its atlas 'macbeth\.txt' is not to be found; .*--atlas-dir"):
        rebuild(small_cube, tmp_path / "cube.uplift")
    assert rebuild(small_cube, tmp_path / "cube.uplift", [MACBETH.parent]).data.atlas.names


def test_an_atlas_of_the_same_name_but_other_content_will_not_do(small_cube, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = MACBETH.read_text(encoding="utf-8")
    (tmp_path / "macbeth.txt").write_text(text + "\n", encoding="utf-8")
    with pytest.raises(CubeFileError, match=r"its atlas 'macbeth\.txt' has changed \(.*macbeth\.txt\)"):
        rebuild(small_cube, tmp_path / "cube.uplift")
    (tmp_path / "atlases").mkdir()
    shutil.copyfile(MACBETH, tmp_path / "atlases" / "macbeth.txt")
    assert rebuild(small_cube, tmp_path / "cube.uplift").data.atlas.names


@pytest.mark.parametrize(
    "changes",
    [{"options": 3}, {"options": {}}, {"atlases": [{"name": "macbeth.txt"}]}, {"atlases": None}],
)
def test_a_cube_that_does_not_say_how_it_was_made_is_refused(small_cube, changes):
    with pytest.raises(CubeFileError, match=r"cube\.uplift: does not say how it was made; build it anew"):
        rebuild(told(small_cube, **changes), "cube.uplift")


def test_options_of_another_version_are_refused(small_cube):
    options = {**small_cube.data.provenance["options"], "temperature": 3}
    with pytest.raises(CubeFileError, match="made with options unknown here"):
        rebuild(told(small_cube, options=options, atlases=[]), "cube.uplift")
