"""``uplift export``."""

import os
import shutil

import numpy as np
import pytest

from uplift.extras.export.coeff import write_coeff

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
    assert run("export", cube, "--format", style).stdout.startswith(
        f"{STEM}.{suffix}: "
    )
    assert (home / f"{STEM}.{suffix}").read_bytes().startswith(first)


@pytest.mark.parametrize("name", ["a.cuh", "a.cu", "a.glsl", "a.hlsl"])
def test_programs_come_with_a_table(run, home, cube, name):
    assert "a.bin" in run("export", cube, "-o", name, "--mode", "moments").stdout
    assert set(os.listdir(home)) == {cube, name, "a.bin"}
    assert "moments" in (home / name).read_text()


def test_the_table_of_a_program_is_a_choice(run, refuse, home, cube):
    run("export -o a.h --table file", cube)
    assert set(os.listdir(home)) == {cube, "a.h", "a.bin"}
    assert refuse("export -o c.cuh --table header", cube).code == "option"
    assert refuse("export -o a.glsl --mode moments", cube).code == "file-exists"
    assert not (home / "a.glsl").exists()


@pytest.mark.parametrize(
    ("name", "output", "code"),
    [
        ("c.uplift", "c.uplift --format npz", "output-is-input"),
        ("c.bin", "c.glsl", "output-is-input"),
        ("c.bin", "c.h --table file", "output-is-input"),
        ("c.bin", "c.glsl --format mixer-glsl", "output-is-input"),
        ("c.uplift", "c.bin --format c --table file", "output"),
        ("c.uplift", "c.toml --format film", "output"),
    ],
)
def test_no_output_replaces_the_cube_or_another(refuse, home, cube, name, output, code):
    """Even with --force, and before anything is written."""
    before = (home / cube).read_bytes()
    (home / cube).rename(home / name)
    assert refuse("export", name, "--force", "-o", *output.split()).code == code
    assert os.listdir(home) == [name]
    assert (home / name).read_bytes() == before


def test_format_follows_the_suffix_of_out(run, home, cube, monkeypatch):
    assert run("export -o table.coeff --res 3", cube).stdout.startswith("table.coeff: ")
    monkeypatch.setattr(
        write_coeff, "__kwdefaults__", {**write_coeff.__kwdefaults__, "res": 2}
    )
    run("export -o table.cpp", cube)
    assert (home / "table.cpp").read_text().startswith("namespace pbrt {")
    assert (home / "table.coeff").read_bytes()[:8] == b"SPEC" + bytes([3, 0, 0, 0])
    run("export -o ANY.NPZ", cube)
    run("export -o points.txt --format npz", cube)
    assert (home / "points.txt").read_bytes().startswith(b"PK")
    assert np.load(home / "ANY.NPZ")["nodes"].shape == (8,)


def test_what_reads_cube_files(run, refuse, misuse, home, cube):
    assert run("export --runtime uplift.h").stdout.startswith("uplift.h: ")
    assert run("export --runtime uplift.js").stdout.startswith("uplift.js: ")
    assert "export async function open" in (home / "uplift.js").read_text()
    run("export --runtime -o other.h")
    assert (home / "uplift.h").read_bytes() == (home / "other.h").read_bytes()
    assert refuse("export --runtime").code == "file-exists"
    misuse("export")
    misuse("export --runtime --format c")
    misuse("export --runtime a.h -o b.h")
    misuse("export --runtime uplift.cjs")
    assert run("export --runtime upper.MJS").stdout.startswith("upper.MJS: ")
    before = (home / cube).read_bytes()
    misuse("export --force --runtime", cube)
    assert (home / cube).read_bytes() == before
