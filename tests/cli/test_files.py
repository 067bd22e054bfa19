"""No command replaces a file that it reads, all outputs are checked before any is written, and any name will do."""

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
INPUTS = ("atlas.txt", "cube.uplift", "image.exr", "colours.csv", "palette.toml", "scene.toml")
LINKS = {
    "link.exr": "image.exr",
    "atlas.png": "atlas.txt",
    "colours.pdf": "colours.csv",
    "cube.svg": "cube.uplift",
    "palette.png": "palette.toml",
    "atlas.html": "atlas.txt",
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
    (home / "scene.toml").write_text('textures = ["image.exr"]\natlases = ["atlas.txt"]\n')
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
        "mix #c8342a --over image.exr -o link.exr",
        "mix black --atlas atlas.txt --plot atlas.png",
        "palette palette.toml --plot palette.png",
        "palette palette.toml -o atlas.txt",
        "palette palette.toml --html atlas.html",
        "plan scene.toml -o image.exr",
        "query --cube cube.uplift #c8342a --plot cube.svg",
        "query --input colours.csv --plot colours.pdf",
        "report cube.uplift --atlas atlas.html -o atlas.html",
        "slices cube.uplift -o cube.uplift",
        "slices cube.uplift --plot cube.uplift",
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
        "palette palette.toml --plot new.png --plot-spectra old.png",
        "slices cube.uplift -o new.exr --plot old.png",
        "texture image.exr link.exr -o out",
    ],
)
def test_nothing_is_written_if_one_output_exists(refuse, home, inputs, words):
    (home / "old.png").write_text("old")
    folder = home / "out"
    folder.mkdir()
    (folder / "link.exr").write_text("old")
    before = {path.name for path in home.iterdir()}
    assert refuse(*words.split()).code == "file-exists"
    assert {path.name for path in home.iterdir()} == before
    assert {path.name for path in folder.iterdir()} == {"link.exr"}


def test_outputs_differ(refuse, inputs):
    words = "palette palette.toml --plot a.png --plot-spectra ./a.png --force"
    assert refuse(*words.split()).code == "output"
