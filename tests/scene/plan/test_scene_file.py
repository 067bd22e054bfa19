"""What a scene file may say, and how it is refused."""

from __future__ import annotations

import dataclasses
import re

import pytest

from uplift.common.errors import PlanFileError
from uplift.scene.plan import SceneFile, read_scene_file


@pytest.fixture
def say(tmp_path):
    """Read a scene file with this text, beside images a.png, b.1.exr and b.2.exr and an atlas c.txt."""
    for name in ("a.png", "b.1.exr", "b.2.exr", "c.txt"):
        (tmp_path / name).touch()

    def say(text):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return read_scene_file(path)

    return say


def test_textures_alone_will_do(say, tmp_path):
    found = say('textures = ["a.png"]')
    assert found == SceneFile(tmp_path / "scene.toml", (tmp_path / "a.png",))
    assert (found.tolerance, found.quantile, found.lights[0]) == (1.0, 0.975, "D65")


def test_all_can_be_said(say, tmp_path):
    found = say(
        'textures = ["a.png", "b.*.exr"]\natlases = "c.txt"\nlights = ["A", "FL11", "a"]\ntolerance = 2\n'
        'quantile = 0.9\nencoding = "linear"\nspace = "ITU-R BT.2020"\nilluminant = "D50"\n'
        'observer = "CIE 1964 10 Degree Standard Observer"'
    )
    assert [path.name for path in found.textures] == ["a.png", "b.1.exr", "b.2.exr"]
    assert found.atlases == (tmp_path / "c.txt",)
    assert (found.lights, found.tolerance, found.quantile) == (("A", "FL11"), 2.0, 0.9)
    assert found.sensor().illuminant == "D50"
    assert [light.name for light in found.light_sources()] == ["A", "FL11"]


def test_every_field_can_be_said(say):
    """A key that is none would be unknown; these are only of the wrong kind."""
    for field in dataclasses.fields(SceneFile)[1:]:
        with pytest.raises(PlanFileError, match=f"{field.name} is no "):
            say(f"textures = 'a.png'\n{field.name} = []" if field.name != "textures" else "textures = 3")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("lights = ['D65']", "scene.toml: names no textures, so there are no colours; add a line such as"),
        ("\ntextures = [", "scene.toml:2: is no TOML: "),
        ("textures = 'a.png'\n\nlight = 'A'", "toml:3: unknown key 'light'; did you mean 'lights'"),
        ("textures = 'x.png'", "toml:1: textures: there is no file .*x.png; paths are taken from"),
        ("textures = 'x.*.png'", r"toml:1: textures: no file is named like 'x.\*.png'; check"),
        ("textures = " + "[" * 50_000, "scene.toml: nests too deeply; write lines such as"),
        ("textures = '" + "x" * 5000 + "*'", "toml:1: textures: 'xxxxxxxxxxxxxxxxxxxx…' is no path"),
        ("textures = '" + "x" * 300 + "'", "toml:1: textures: there is no file "),
        ('textures = "x\\u0000*"', "toml:1: textures: 'x.*…' is no path; name a file"),
        ("textures = []", "toml:1: textures is no list of names; write textures = "),
        ("textures = [3]", "toml:1: textures is no list of names"),
        ("textures = 'a.png'\natlases = 'd.txt'", "toml:2: atlases: there is no file"),
        ("textures = 'a.png'\nlights = ['FL99']", "toml:2: unknown illuminant 'FL99'; did you mean"),
        ("textures = 'a.png'\nlights = []", "toml:2: lights is no list of names"),
        (
            "textures = 'a.png'\ntolerance = 0",
            "toml:2: tolerance is no number from 0.01 to 100; write tolerance = 1.0",
        ),
        ("textures = 'a.png'\ntolerance = true", "toml:2: tolerance is no number"),
        ("textures = 'a.png'\ntolerance = nan", "toml:2: tolerance is no number"),
        ("textures = 'a.png'\nquantile = 97.5", "toml:2: quantile is no number from 0.5 to 1"),
        ("textures = 'a.png'\nspace = 3", 'toml:2: space is no name; write space = "sRGB"'),
        ("textures = 'a.png'\nspace = 'sRGV'", "toml:2: unknown RGB space 'sRGV'"),
        ("textures = 'a.png'\nencoding = 'gamma'", "toml:2: unknown encoding 'gamma'; use one of auto"),
        ("textures = 'a.png'\nilluminant = 'D66'", "toml:2: unknown illuminant 'D66'"),
        ("textures = 'a.png'\nobserver = 'me'", "toml:2: unknown observer 'me'"),
        ("textures = 'a.png'\n[lights]\nD65 = 1", "toml:2: lights is no list of names"),
    ],
)
def test_what_is_refused_has_its_line_and_a_remedy(say, text, message):
    with pytest.raises(PlanFileError, match=message) as caught:
        say(text)
    assert re.search("; .", str(caught.value))


def test_a_file_that_is_none_is_refused(tmp_path):
    with pytest.raises(PlanFileError, match=r"none.toml: cannot be read: .*; name a scene file"):
        read_scene_file(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(PlanFileError, match=r"bytes.toml: is no text; write it in UTF-8"):
        read_scene_file(tmp_path / "bytes.toml")
