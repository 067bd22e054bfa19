"""docs/integrate.md: the code blocks run and agree with the cube."""

import re
import shutil
from pathlib import Path

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
from numpy.testing import assert_allclose

from tests.compiling import compile_in
from tests.helpers import output_of
from tests.parts import CC, CXX, MITSUBA, NODE, SANITIZED, SANITIZERS, need
from uplift.extras import texture
from uplift.extras.export.module import write_module
from uplift.extras.export.program import write_program
from uplift.extras.export.runtime import write_header

PAGE = (Path(__file__).parents[3] / "docs" / "integrate.md").read_text("utf-8")
STORED = "moments-8-macbeth.uplift"
COLOURS = [[0.8, 0.2, 0.1], [0.1, 0.2, 0.8]]


def code(section, language):
    """Return the only code block of a section in a language."""
    (text,) = re.findall(
        rf"^## {section}\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE
    )
    (block,) = re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)
    return block


@pytest.fixture
def folder(repository, tmp_path, monkeypatch):
    """Working folder with the cube of the page."""
    shutil.copy(repository / "cubes" / STORED, tmp_path / "paints.uplift")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_python(folder, small_cube):
    names = {}
    exec(compile(code("Python", "python"), "integrate.md", "exec"), names)
    expected = small_cube.reflectance(
        names["texels"][2, 3:4], names["hero"], mode="moments"
    )
    assert_allclose(names["reflectance"], expected, atol=1e-12)


@pytest.mark.parametrize(
    ("section", "compiler", "language", "part"),
    [
        ("C and C\\+\\+", "cc", "c", CC),
        ("C and C\\+\\+", "c++", "c++", CXX),
        ("Cube files at run time", "cc", "c", CC),
    ],
)
def test_c_and_cpp(folder, small_cube, section, compiler, language, part):
    need(part, SANITIZERS)
    write_program(small_cube.data, folder / "paints.h")
    write_header(folder / "uplift.h")
    (folder / "main.c").write_text(code(section, "c"))
    options = ("-x", language, "-O0", *SANITIZED)
    program = compile_in(folder, compiler, *options)
    wavelengths, *found = np.loadtxt(output_of(program).splitlines()).T
    rgb = [COLOURS[0], *COLOURS][-len(found) :]
    expected = small_cube.reflectance(rgb, wavelengths, mode="spectra")
    assert_allclose(found, expected, atol=2e-5)


@pytest.mark.parametrize("channels", ["RGB", "RGBA"])
def test_the_shader_of_osl_begins_with_the_first_multiplier(
    folder, small_cube, channels
):
    """As OpenImageIO, by which OSL reads, counts the channels of a texture."""
    shader = code("Blender, OSL", "osl")
    default = re.search(r"int first_channel = (\d)", shader)
    with_alpha = re.search(r"set `first_channel` to (\d)", PAGE)
    pixels = np.full((2, 2, len(channels)), 0.5, np.float32)
    image = {"type": OpenEXR.scanlineimage}
    OpenEXR.File(image, {channels: pixels}).write("wood.exr")
    texture.convert(
        texture.prepare(small_cube, texture.Multipliers()), "wood.exr", "a.exr"
    )
    spec = OpenImageIO.ImageInput.open("a.exr").spec()
    stated = with_alpha if "A" in channels else default
    assert spec.channelnames.index("multiplier.00") == int(stated[1])


def test_javascript(folder, small_cube):
    need(NODE)
    write_module(folder / "uplift.js")
    (folder / "package.json").write_text('{"type": "module"}')
    (folder / "main.js").write_text(code("JavaScript", "js"))
    wavelengths, *found = np.loadtxt(output_of("node", "main.js").splitlines()).T
    expected = small_cube.reflectance(COLOURS, wavelengths, mode="spectra")
    assert_allclose(found, expected, atol=2e-5)


def test_mitsuba(folder, small_cube):
    need(MITSUBA)
    import mitsuba as mi

    names = {}
    exec(compile(code("Mitsuba", "python"), "integrate.md", "exec"), names)
    image = np.array(names["image"])
    assert image.shape == (64, 64, 3)
    assert mi.variant() == "scalar_spectral"
    assert_allclose(image[30:34, 30:34].mean(axis=(0, 1)), COLOURS[0], atol=0.05)
    assert_allclose(image[:4, :4].mean(axis=(0, 1)), 1, atol=0.05)
