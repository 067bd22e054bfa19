"""docs/guides/mixer.md: its examples run."""

import re
from pathlib import Path

import pytest

import uplift
from tests.compiling import compile_in
from tests.helpers import output_of
from tests.parts import CC, GLSLANG, NODE, need
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.paint.mixer_programs import write_mixer

PAGE = Path(__file__).parents[3] / "docs" / "guides" / "mixer.md"
GREEN = re.search(r"are `(#\w{6})` at 1:1", PAGE.read_text("utf-8"))[1]


def code(language):
    """Return the code blocks of the page in a language, joined."""
    blocks = re.findall(rf"```{language}\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    return "\n".join(blocks)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("guide")
    cube = uplift.load()
    write_mixer(cube, folder / "paint.h")
    write_mixer(cube, folder / "paint.glsl", style="mixer-glsl")
    write_mixer(cube, folder / "paint.mjs", style="mixer-js")
    return folder


def as_hex(words):
    return "#" + bytes(map(int, words.split())).hex()


def test_c(folder):
    need(CC)
    main, brush = code("c").split("float brush[", maxsplit=1)
    stroke = (
        "void stroke(const float brush_rgb[3], float opacity, float canvas_rgb[3])\n"
        f"{{\nfloat brush[{brush}}}\n"
    )
    (folder / "main.c").write_text(main.replace("int main", stroke + "int main"))
    program = compile_in(folder, "cc", "-O1")
    assert as_hex(output_of(program)) == GREEN


def test_glsl(folder):
    need(GLSLANG)
    text = (folder / "paint.glsl").read_text()
    (folder / "a.frag").write_text(f"#version 330\n{text}{code('glsl')}")
    output_of("glslangValidator", "a.frag", cwd=folder)


def test_javascript(folder):
    need(NODE)
    (folder / "main.mjs").write_text(code("javascript"))
    green, _ = output_of("node", folder / "main.mjs").splitlines()
    assert as_hex(green) == GREEN


def test_python():
    names = {}
    exec(compile(code("python"), "mixer.md", "exec"), names)
    assert hex_codes(names["green"][None]) == [GREEN]
