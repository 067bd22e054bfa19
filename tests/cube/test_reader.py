"""docs/reader.py, the reader that docs/cube-file.md describes, answers as uplift does,
without it.
"""

import importlib.util
import sys
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import ROOT
from tests.cube.cube_files import forge
from tests.helpers import output_of
from uplift.lookup.cube import PACKAGED, Cube

READER = ROOT / "docs" / "reader.py"
SPEC = importlib.util.spec_from_file_location("reader", READER)
reader = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(reader)
COLOURS = np.concatenate(
    [
        list(product((0, 0.02, 0.25, 0.6, 1), repeat=3)),
        np.random.default_rng(0).random((44, 3)),
    ]
)
AT = [380.0, 455.5, 550.0, 602.0, 780.0]


def compare(cube, path, rgb, within):
    found = reader.Cube(path)
    answers = [found.reflectance(colour, AT) for colour in rgb]
    assert_allclose(answers, cube.reflectance(rgb, AT), rtol=0, atol=within)


def test_all_colours_of_acescg_those_that_are_moved_too():
    compare(uplift.load("acescg"), PACKAGED["acescg"], COLOURS, 1e-8)
    compare(uplift.load(), PACKAGED["srgb"], COLOURS[::9], 1e-13)


@pytest.mark.parametrize("name", ["moments-8-macbeth", "sigmoid-8-macbeth"])
def test_entries_and_their_boxes(name):
    cube = uplift.load(ROOT / "cubes" / f"{name}.uplift")
    near = np.clip(cube.data.atlas.rgb + 0.01, 0, 1)
    compare(
        cube,
        ROOT / "cubes" / f"{name}.uplift",
        np.concatenate([cube.data.atlas.rgb, near, COLOURS[::9]]),
        1e-13,
    )


@pytest.mark.parametrize(
    ("space", "model"), [("ITU-R BT.2020", "moments"), ("ProPhoto RGB", "sigmoid")]
)
def test_other_spaces_and_models(tmp_path, space, model):
    cube = uplift.build(dim=3, space=space, model=model)
    cube.save(tmp_path / "a.uplift")
    compare(cube, tmp_path / "a.uplift", COLOURS[::6], 1e-8)


def test_sparse_cubes_have_the_colours_of_their_scene(tmp_path):
    data = uplift.load().data
    corners = data.lattice.corners(np.full((1, 3), 0.3))[0][0]
    sparse = Cube(replace(data, points=data.points.restricted_to(corners)))
    sparse.save(tmp_path / "a.uplift")
    compare(sparse, tmp_path / "a.uplift", np.full((1, 3), 0.3), 1e-13)


def test_it_runs_without_uplift():
    command = (sys.executable, "-I", READER, PACKAGED["srgb"])
    found = output_of(*command, *["0.8", "0.2", "0.1", "500", "600"]).splitlines()
    expected = uplift.load().reflectance([0.8, 0.2, 0.1], [500, 600])
    assert_allclose(np.loadtxt(found)[:, 1], expected, atol=1e-11)
    imports = [line.split()[:2] for line in READER.read_text().splitlines()]
    assert not {("import", "uplift"), ("from", "uplift")} & {*map(tuple, imports)}


def test_damaged_files_and_unknown_features_are_refused(tmp_path):
    data = bytearray(PACKAGED["srgb"].read_bytes())
    data[-9] ^= 1
    (tmp_path / "a.uplift").write_bytes(data)
    with pytest.raises(ValueError, match="damaged"):
        reader.Cube(tmp_path / "a.uplift")
    other = forge(
        uplift.load().data,
        tmp_path / "b.uplift",
        lambda _, metadata: metadata["features"].append("polarised"),
    )
    with pytest.raises(ValueError, match="feature"):
        reader.Cube(other)
