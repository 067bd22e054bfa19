"""No command replaces a file that it reads, all outputs are checked before any is
written, and any name will do.
"""

import contextlib
import importlib
import itertools
import os
import re
import shutil
from itertools import chain
from types import SimpleNamespace

import numpy as np
import pytest
from uplift_cli.main import main
from uplift_cli.option_types import OutputFile

from tests.extras.paint.invented import invented
from tests.extras.texture.conftest import planes, write_exr
from uplift.extras.paint.paints_file import to_toml

from .conftest import commands

resource = None if os.name == "nt" else importlib.import_module("resource")
PALETTE = """
[lights]
day = {illuminant = "D65"}

[materials]
card = {atlas = "atlas.txt", entry = "blue"}
paint = {rgb = [0.5, 0.5, 0.5], cube = "cube.uplift"}
"""
CONTENT = {
    "colours.csv": "0.5,0.5,0.5\n",
    "camera.csv": "380,1,0,0\n550,0,1,0\n780,0,0,1\n",
    "looks.toml": "",
    "chart.csv": "",
    "lamp.csv": "400,1\n550,2\n700,3\n",
    "paint.csv": "",
    "recipes.csv": "",
    "samples.csv": "",
    "paints.toml": to_toml(invented()),
    "answers.csv": "",
    "plan.json": "",
    "palette.toml": PALETTE,
    "scene.toml": 'textures = ["image.exr"]\natlases = ["atlas.txt"]\n',
}
NAMED = {
    "recorded.uplift": ("macbeth.txt",),
    "palette.toml": ("atlas.txt", "cube.uplift"),
    "plan.json": ("image.exr", "atlas.txt"),
    "scene.toml": ("image.exr", "atlas.txt"),
    "wood.*.exr": ("wood.1.exr", "wood.2.exr"),
    "2:paint.csv": ("paint.csv",),
}
"""Inputs that other inputs, patterns and texts name."""
WRITTEN = """
advise image.exr wood.*.exr --cube cube.uplift --light lamp.csv | --plot x.png | x.png
atlas atlas.txt library.txt | -o x.txt | x.txt
lab bounds --cube cube.uplift --input colours.csv | --plot x.pdf | x.pdf
lab bounds --cube cube.uplift --input colours.csv | --html x.html | x.html
build --atlas atlas.txt --library library.txt --look looks.toml --observer camera.csv \
| -o x.uplift | x.uplift
build --atlas atlas.txt --library library.txt --scene image.exr --light lamp.csv \
| -o x.uplift --debug | x.exr
build --plan plan.json | -o x.uplift | x.uplift
build --plan plan.json | | plan.uplift
chart --from chart.csv --atlas atlas.txt \
| -o out | out/chart.csv out/chart.png out/chart.html
lab compare --atlas atlas.txt --atlas library.txt \
| -o out | out/compare-boxes.png out/compare-cost.png out/compare.html
lab compare --atlas atlas.txt --write PF16 | -o out | out/surfaces.csv out/lights.csv
lab diff cube.uplift cube2.uplift image.exr wood.*.exr | -o x.html | x.html
export cube.uplift | -o x.npz | x.npz
export cube.uplift | -o x.glsl | x.glsl x.bin
export cube.uplift | -o x.h --table file | x.h x.bin
export cube.uplift | -o x.glsl --format mixer-glsl | x.glsl x.bin
export cube.uplift --light lamp.csv | -o x.cube | x.cube
export paints.toml | -o x.h | x.h
export paints.toml | -o x.html | x.html
lights build --atlas atlas.txt | -o x.uplift | x.uplift
lights export lights.uplift | -o x.h --table file | x.h x.bin
lights export lights.uplift | -o x.glsl | x.glsl x.bin
lights info lights.uplift | --plot x.svg | x.svg
lights query --lights lights.uplift --input colours.csv | --plot x.png | x.png
lights texture image.exr --lights lights.uplift | -o x.exr | x.exr
paints mix #c8342a --atlas atlas.txt --cube cube.uplift | --plot x.png | x.png
paints mix --duntley 2:paint.csv --cube cube.uplift | --plot x.png | x.png
paints mix #c8342a --over image.exr --cube cube.uplift | -o x.exr | x.exr
paints mix white --paints paints.toml --cube cube.uplift | --plot x.png | x.png
paints mix white --paints paints.toml --over image.exr --cube cube.uplift \
| -o x.exr | x.exr
paints fit samples.csv --recipes recipes.csv | -o x.toml | x.toml
paints match #c8342a --paints paints.toml --atlas atlas.txt --cube cube.uplift \
| --plot x.png | x.png
paints match --spectrum atlas.txt --paints paints.toml | --plot x.png | x.png
export paints.toml | -o x.h | x.h
lab palette palette.toml | -o x.txt | x.txt
lab palette palette.toml | --plot x.png --plot-spectra y.png | x.png y.png
lab palette palette.toml --image image.exr | --html x.html | x.html
passes choose image.exr --atlas atlas.txt --cube cube.uplift --light lamp.csv \
| -o x.toml | x.toml
passes decode wood.1.exr wood.2.exr --passes passes.toml | -o x.exr | x.exr
plan scene.toml | -o x.json | x.json
plan scene.toml | | scene.plan.json
query --cube cube.uplift --input colours.csv | --plot x.png | x.png
relight image.exr wood.*.exr --cube cube.uplift | -o x.png | x.png
relight image.exr --atlas atlas.txt --atlas library.txt | -o x.html | x.html
relight image.exr --cube cube.uplift --light lamp.csv | -o x.exr | x.exr
report recorded.uplift | -o x.html | x.html
report cube2.uplift --atlas atlas.txt --light lamp.csv | | cube2.html
slices cube.uplift | -o x.exr | x.exr
slices cube.uplift | -o x.exr --plot x.png | x.exr x.png
lab study moments --atlas atlas.txt | -o out | out/moments.png out/moments-patches.png
lab study stability --atlas atlas.txt | -o out | out/stability.png
lab study sensitivity recorded.uplift | -o out | out/sensitivity-locality.png
texture image.exr --cube cube.uplift --cube cube2.uplift --mask mask.exr \
| -o x.exr | x.exr
texture image.exr wood.*.exr --errors lamp.csv | -o out | out/image.exr out/wood.2.exr
texture image.exr --passes passes.toml | -o x | x.1.exr x.2.exr
lights texture image.exr --passes passes.toml | -o x | x.1.exr x.2.exr
lab wavelengths --count 4 --atlas atlas.txt --observer camera.csv --light lamp.csv \
| --plot x.png | x.png
"""
"""Commands with all their inputs | the outputs that are added | the files that these
are.
"""
WITHOUT_ROWS = {
    "check": "--update replaces the cubes that it checks",
    "samples": "reads no file of the user",
}
"""Commands without a row, and why."""


@pytest.fixture
def inputs(home, cubes, macbeth, passes_text, monkeypatch):
    """A file of each kind in the working folder, by name with its bytes."""
    for name in ("atlas.txt", "library.txt", "macbeth.txt"):
        shutil.copy(macbeth, home / name)
    for name in ("cube.uplift", "cube2.uplift", "recorded.uplift"):
        shutil.copy(cubes / "moments-8-macbeth.uplift", home / name)
    shutil.copy(
        cubes.parent / "uplift" / "extras" / "emission" / "emission.uplift",
        home / "lights.uplift",
    )
    for name in ("image.exr", "mask.exr", "wood.1.exr", "wood.2.exr"):
        write_exr(home / name, planes(np.full((2, 2, 3), 0.5, np.float32)))
    for name, text in CONTENT.items():
        (home / name).write_text(text)
    (home / "passes.toml").write_text(passes_text, encoding="utf-8")
    images = SimpleNamespace(paths=("image.exr",))
    plan = SimpleNamespace(images=images, atlases=("atlas.txt",), build=print)
    monkeypatch.setattr("uplift.extras.scene.plan.files.read_plan", lambda path: plan)
    return {path.name: path.read_bytes() for path in home.iterdir()}


def read_by(words, inputs):
    """Names of the inputs of a command line, and of those that they name."""
    named = list(chain.from_iterable((word, *NAMED.get(word, ())) for word in words))
    sources = set(named) & set(inputs)
    assert sources
    return sources


@pytest.mark.parametrize("row", WRITTEN.strip().splitlines())
def test_no_output_replaces_an_input_or_without_force_any_file(
    refuse, home, inputs, row
):
    (home / "out").mkdir()
    words, output, files = map(str.split, row.split("|"))
    for link, source in itertools.product(files, read_by(words, inputs)):
        (home / link).symlink_to(home / source)
        assert refuse(*words, *output, "--force").code == "output-is-input", source
        (home / link).unlink()
    for file in files:
        (home / file).write_text("old")
        assert refuse(*words, *output).code == "file-exists", file
        (home / file).unlink()
    assert not os.listdir(home / "out")
    after = {path.name: path.read_bytes() for path in home.iterdir() if path.is_file()}
    assert after == inputs


def test_every_output_of_every_command_has_a_row():
    for path, command in commands(main).items():
        if path in WITHOUT_ROWS:
            continue
        rows = re.findall(rf"^{path} .*", WRITTEN, re.MULTILINE)
        words = set(" ".join(rows).split())
        for param in command.params:
            if param.name == "force":
                assert rows, path
            if isinstance(param.type, OutputFile):
                assert words & set(param.opts), path


@contextlib.contextmanager
def full_disk():
    """Files end at a kilobyte, as on a disk without space."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.skipif(resource is None, reason="no limits of POSIX")
@pytest.mark.parametrize(
    "words",
    [
        "query #888 --plot x.svg",
        "slices cube.uplift -o x.exr",
        "slices cube.uplift --plot x.png",
        "export cube.uplift -o x.h",
        "relight --cube cube.uplift -o x.html",
        "texture image.exr --wavelengths 400:700:1 -o x.exr",
        "atlas atlas.txt -o x.csv",
        "lights export lights.uplift -o x.glsl",
    ],
)
def test_a_full_disk_is_an_error_of_the_output(refuse, home, inputs, words):
    with full_disk():
        error = refuse(words)
    assert error.code == "output"
    assert set(os.listdir(home)) == {*inputs}
