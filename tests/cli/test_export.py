"""``uplift export`` from the outside."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

STEM = "moments-8-macbeth"


@pytest.fixture
def cube(home, cubes):
    """A cube file in the working folder."""
    shutil.copy(cubes / f"{STEM}.uplift", home)
    return f"{STEM}.uplift"


@pytest.mark.parametrize(
    ("to", "name", "told", "first"),
    [
        ("c", f"{STEM}.h", "C99 header, 512 points, 23 atlas entries, 0.1 MB", b"/* A spectral"),
        ("npz", f"{STEM}.npz", "21 arrays", b"PK"),
        ("csv", f"{STEM}.csv", "512 lattice points", b"r,g,b,lattice_r"),
    ],
)
def test_formats_and_their_names(run, home, cube, to, name, told, first):
    assert run("export", cube, "--format", to).stdout == f"{name}: {told}\n"
    assert (home / name).read_bytes().startswith(first)


def test_the_format_is_as_out_is_called(run, home, cube):
    told = run("export", cube, "table.coeff", "--res", 3).stdout
    assert told.startswith("table.coeff: sigmoids for rgb2spec's readers, colours within ")
    assert (home / "table.coeff").read_bytes()[:8] == b"SPEC" + bytes([3, 0, 0, 0])
    run("export", cube, "ANY.NPZ")
    assert np.load(home / "ANY.NPZ")["nodes"].shape == (8,)


def test_out_need_not_be_called_as_its_format(run, home, cube):
    run("export", cube, "points.txt", "--format", "csv")
    assert (home / "points.txt").read_text().startswith("r,g,b")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((), "Name a format"),
        (("cube.exr",), "Name a format"),
        (("cube.h", "--res", "8"), "--res is for --format coeff alone"),
        ((f"./{STEM}.uplift", "--format", "csv", "--force"), "OUT is the cube itself"),
    ],
)
def test_usage(run, home, cube, cubes, arguments, told):
    assert told in run("export", cube, *arguments, code=2).output
    assert [path.name for path in home.iterdir()] == [cube]
    assert (home / cube).read_bytes() == (cubes / cube).read_bytes()


def test_nothing_is_replaced_unasked(run, refuse, home, cube):
    (home / "cube.csv").write_text("mine")
    assert "exists already" in refuse("export", cube, "cube.csv")
    assert (home / "cube.csv").read_text() == "mine"
    run("export", cube, "cube.csv", "--force")
    assert (home / "cube.csv").read_text() != "mine"


def test_bad_input(refuse, home, cube):
    assert "no such file" in refuse("export", "missing.uplift", "cube.csv")
    assert "use 2 to 256" in refuse("export", cube, "cube.coeff", "--res", "1")
    assert "does not exist" in refuse("export", cube, "missing/cube.csv")
    assert [path.name for path in home.iterdir()] == [cube]
