"""No command replaces a file that it reads, and all outputs are checked before any is written."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

from tests.io.texture.conftest import planes, write_exr

PALETTE = """
[lights]
day = {illuminant = "D65"}

[materials]
card = {atlas = "atlas.txt", entry = "blue"}
paint = {rgb = [0.5, 0.5, 0.5], cube = "cube.uplift"}
"""
SCENE = """
textures = ["image.exr"]
atlases = ["atlas.txt"]
"""
INPUTS = ("atlas.txt", "cube.uplift", "image.exr", "colours.csv", "palette.toml", "scene.toml")
LINKS = {
    "link.exr": "image.exr",
    "atlas.png": "atlas.txt",
    "colours.pdf": "colours.csv",
    "cube.svg": "cube.uplift",
    "palette.png": "palette.toml",
}
"""Other names of inputs, with suffixes of outputs."""


@pytest.fixture
def inputs(home, cubes, macbeth):
    """A file of each kind in the working folder, and links to it."""
    shutil.copy(macbeth, home / "atlas.txt")
    shutil.copy(cubes / "moments-8-macbeth.uplift", home / "cube.uplift")
    write_exr(home / "image.exr", planes(np.full((2, 2, 3), 0.5, np.float32)))
    (home / "colours.csv").write_text("0.5,0.5,0.5\n")
    (home / "palette.toml").write_text(PALETTE)
    (home / "scene.toml").write_text(SCENE)
    for link, target in LINKS.items():
        (home / link).symlink_to(target)
    return {name: (home / name).read_bytes() for name in INPUTS}


@pytest.mark.parametrize(
    "words",
    [
        "atlas atlas.txt -o ./atlas.txt",
        "build --atlas atlas.txt -o atlas.txt",
        "build --scene image.exr -o link.exr",
        "export cube.uplift -o cube.uplift --format csv",
        "mix #c8342a --over image.exr -o image.exr",
        "mix #c8342a --over image.exr -o link.exr",
        "mix black --atlas atlas.txt --plot atlas.png",
        "palette palette.toml --plot palette.png",
        "palette palette.toml -o atlas.txt",
        "palette palette.toml --plot-spectra palette.png",
        "palette palette.toml --html image.exr --image image.exr",
        "plan scene.toml -o scene.toml",
        "plan scene.toml -o image.exr",
        "plan scene.toml -o atlas.txt",
        "query --cube cube.uplift #c8342a --plot cube.svg",
        "query --input colours.csv --plot colours.pdf",
        "report cube.uplift -o cube.uplift",
        "report cube.uplift --atlas atlas.txt -o atlas.txt",
        "slices cube.uplift -o cube.uplift",
        "slices cube.uplift --plot cube.uplift",
        "texture image.exr -o image.exr",
        "texture image.exr -o link.exr",
        "texture image.exr -o .",
        "wavelengths --count 4 --atlas atlas.txt --plot atlas.png",
    ],
)
def test_inputs_are_not_replaced(refuse, home, inputs, words):
    assert refuse(*words.split(), "--force").code == "output-is-input"
    assert {name: (home / name).read_bytes() for name in INPUTS} == inputs
    assert {path.name for path in home.iterdir()} == {*INPUTS, *LINKS}


@pytest.mark.parametrize(
    "words",
    [
        "palette palette.toml --plot new.png --plot-spectra {}",
        "plan scene.toml -o {}.json",
        "slices cube.uplift -o new.exr --plot {}",
        "texture image.exr link.exr -o {}",
    ],
)
def test_nothing_is_written_if_one_output_exists(refuse, home, inputs, words):
    for name in ("old.png", "old.html"):
        (home / name).write_text("old")
    folder = home / "out"
    folder.mkdir()
    (folder / "link.exr").write_text("old")
    before = {path.name for path in home.iterdir()}
    old = "out" if "texture" in words else "old" if "plan" in words else "old.png"
    assert refuse(*words.format(old).split()).code == "file-exists"
    assert {path.name for path in home.iterdir()} == before
    assert {path.name for path in folder.iterdir()} == {"link.exr"}


@pytest.mark.parametrize(
    "words",
    ["palette palette.toml --plot a.png --plot-spectra ./a.png", "slices cube.uplift -o a.exr --plot ./a.exr"],
)
def test_outputs_differ(refuse, inputs, words):
    assert refuse(*words.split(), "--force").code == "duplicate-output"
