"""``uplift export``."""

import os
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
    ("style", "suffix", "first"),
    [
        ("c", "h", b"/* A spectral"),
        ("npz", "npz", b"PK"),
        ("html", "html", b"<!DOCTYPE"),
        ("mixer-c", "h", b"/* Mixes RGB"),
        ("mixer-js", "mjs", b"/* Mixes RGB"),
    ],
)
def test_formats_and_default_names(run, home, cube, style, suffix, first):
    run("export", cube, "--format", style)
    assert (home / f"{STEM}.{suffix}").read_bytes().startswith(first)


@pytest.mark.parametrize(
    "words",
    [
        "a.cuh --mode moments",
        "a.cu --mode moments",
        "a.glsl --mode moments",
        "a.hlsl --mode moments",
        "a.h --table file",
    ],
)
def test_programs_come_with_a_table(run, home, cube, words):
    name, *options = words.split()
    run("export", cube, "-o", name, *options)
    assert set(os.listdir(home)) == {cube, name, "a.bin"}
    assert "moments" in (home / name).read_text()


def test_format_follows_the_suffix_of_out(run, home, cube):
    run("export -o table.coeff --res 3", cube)
    assert (home / "table.coeff").read_bytes()[:8] == b"SPEC" + bytes([3, 0, 0, 0])
    run("export -o ANY.NPZ", cube)
    assert np.load(home / "ANY.NPZ")["nodes"].shape == (8,)
    run("export -o points.txt --format npz", cube)
    assert (home / "points.txt").read_bytes().startswith(b"PK")


def test_what_reads_cube_files(run, refuse, home):
    run("export --runtime uplift.js")
    assert "export async function open" in (home / "uplift.js").read_text()
    run("export --runtime upper.MJS")
    run("export --runtime -o other.h")
    run("export --runtime")
    assert (home / "uplift.h").read_bytes() == (home / "other.h").read_bytes()
    assert refuse("export --runtime").code == "file-exists"
