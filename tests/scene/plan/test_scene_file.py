"""Contents of scene files, and the errors of invalid ones."""

from __future__ import annotations

import dataclasses

import pytest

from tests.helpers import raises
from uplift.common.errors import PlanFileError
from uplift.scene.plan import SceneFile, read_scene_file


@pytest.fixture
def read(tmp_path):
    """A function that reads a scene file of this text, next to a.png, b.1.exr, b.2.exr and c.txt."""
    for name in ("a.png", "b.1.exr", "b.2.exr", "c.txt"):
        (tmp_path / name).touch()

    def read(text):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return read_scene_file(path)

    return read


def test_textures_are_the_only_required_key(read, tmp_path):
    scene = read('textures = ["a.png"]')
    assert scene == SceneFile(tmp_path / "scene.toml", (tmp_path / "a.png",))
    assert (scene.tolerance, scene.quantile, scene.lights[0]) == (1.0, 0.975, "D65")


def test_all_keys_are_read(read, tmp_path):
    scene = read(
        'textures = ["a.png", "b.*.exr"]\natlases = "c.txt"\nlights = ["A", "FL11", "a"]\ntolerance = 2\n'
        'quantile = 0.9\nencoding = "linear"\nspace = "ITU-R BT.2020"\nilluminant = "D50"\n'
        'observer = "CIE 1964 10 Degree Standard Observer"'
    )
    assert [path.name for path in scene.textures] == ["a.png", "b.1.exr", "b.2.exr"]
    assert scene.atlases == (tmp_path / "c.txt",)
    assert (scene.lights, scene.tolerance, scene.quantile) == (("A", "FL11"), 2.0, 0.9)
    assert scene.encoding == "linear"
    sensor = scene.sensor()
    assert (sensor.space, sensor.illuminant) == ("ITU-R BT.2020", "D50")
    assert sensor.observer == "CIE 1964 10 Degree Standard Observer"
    assert [light.name for light in scene.light_sources()] == ["A", "FL11"]


@pytest.mark.parametrize("field", dataclasses.fields(SceneFile)[1:], ids=lambda field: field.name)
def test_every_field_is_a_key_with_a_checked_type(read, field):
    lines = f"{field.name} = {{}}" if field.name == "textures" else f"textures = 'a.png'\n{field.name} = {{}}"
    with raises(PlanFileError, "invalid-value") as caught:
        read(lines)
    assert caught.value.problem.startswith(f"{field.name} must be ")
    assert caught.value.problem.endswith(", got {}")


TEXTURES = "textures = 'a.png'\n"


@pytest.mark.parametrize(
    ("text", "code", "line", "key"),
    [
        ("lights = ['D65']", "missing-key", None, "textures"),
        ("\ntextures = [", "invalid-toml", 2, ""),
        ("textures = " + "9" * 5000, "invalid-toml", 1, ""),
        ("textures = " + "[" * 50_000, "invalid-toml", 1, ""),
        ("a." * 2000 + "b = 1", "invalid-toml", 1, ""),
        (TEXTURES + "\nlight = 'A'", "unknown-key", 3, "light"),
        (TEXTURES + "path = 'A'", "unknown-key", 2, "path"),
        ("textures = 'x.png'", "file-not-found", 1, "textures"),
        ("textures = 'x.*.png'", "file-not-found", 1, "textures"),
        ("textures = ['a.png', '" + "x" * 300 + "']", "file-not-found", 1, "textures[1]"),
        ("textures = '.'", "file-not-found", 1, "textures"),
        ("textures = '" + "x" * 5000 + "*'", "invalid-path", 1, "textures"),
        ('textures = ["x\\u0000*"]', "invalid-path", 1, "textures[0]"),
        ("textures = ''", "invalid-path", 1, "textures"),
        ("textures = []", "invalid-value", 1, "textures"),
        ("textures = [3]", "invalid-value", 1, "textures[0]"),
        (TEXTURES + "atlases = 'd.txt'", "file-not-found", 2, "atlases:"),
        (TEXTURES + "lights = ['D65', 'FL99']", "unknown-illuminant", 2, "lights[1]"),
        (TEXTURES + "lights = []", "invalid-value", 2, "lights"),
        (TEXTURES + "[lights]\nD65 = 1", "invalid-value", 2, "lights"),
        (TEXTURES + "tolerance = 0", "invalid-value", 2, "tolerance"),
        (TEXTURES + "tolerance = true", "invalid-value", 2, "tolerance"),
        (TEXTURES + "tolerance = nan", "invalid-value", 2, "tolerance"),
        (TEXTURES + "tolerance = 1" + "0" * 400, "invalid-value", 2, "tolerance"),
        (TEXTURES + "tolerance = 0x1" + "0" * 9000, "invalid-value", 2, "tolerance"),
        (TEXTURES + "quantile = 97.5", "invalid-value", 2, "quantile"),
        (TEXTURES + 'space = "a\\nb"', "unknown-rgb-space", 2, "space"),
        (TEXTURES + 'space = "' + "x" * 5000 + '"', "unknown-rgb-space", 2, "space"),
        (TEXTURES + '"a\\nb" = 3', "unknown-key", None, "a b"),
        (TEXTURES + "space = 3", "invalid-value", 2, "space"),
        (TEXTURES + "space = 'sRGV'", "unknown-rgb-space", 2, "space"),
        (TEXTURES + "illuminant = 'D66'", "unknown-illuminant", 2, "illuminant"),
        (TEXTURES + "observer = 'me'", "unknown-observer", 2, "observer"),
    ],
)
def test_an_invalid_file_is_refused_with_line_and_key(read, text, code, line, key):
    with raises(PlanFileError, code) as caught:
        read(text)
    error = caught.value
    assert (error.path.name, error.line) == ("scene.toml", line)
    assert error.problem.startswith(key)
    assert len(error.problem) < 500
    assert "\n" not in str(error)


def test_an_unknown_encoding_is_refused(read):
    with pytest.raises(PlanFileError) as caught:
        read(TEXTURES + "encoding = 'gamma'")
    assert caught.value.line == 2
    assert "'gamma'" in caught.value.problem


@pytest.mark.parametrize(
    ("text", "suggestion"),
    [("tolerence = 1", "'tolerance'"), ("lights = 'D66'", "'D65'"), ("space = 'sRGV'", "'sRGB'")],
)
def test_the_nearest_name_is_suggested(read, text, suggestion):
    with pytest.raises(PlanFileError) as caught:
        read(TEXTURES + text)
    assert suggestion in caught.value.hint


def test_the_received_value_is_reported(read):
    with raises(PlanFileError, "invalid-value") as caught:
        read(TEXTURES + "quantile = 97.5")
    assert caught.value.problem == "quantile must be less than or equal to 1, got 97.5"


def test_a_missing_or_binary_file_is_refused(tmp_path):
    with raises(PlanFileError, "file-not-found"):
        read_scene_file(tmp_path / "none.toml")
    with raises(PlanFileError, "not-a-regular-file"):
        read_scene_file(tmp_path)
    with raises(PlanFileError, "file-unreadable"):
        read_scene_file(tmp_path / "a\0b.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with raises(PlanFileError, "file-unreadable"):
        read_scene_file(tmp_path / "bytes.toml")


def test_a_file_of_many_bytes_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("uplift.common.spec_file.MAX_BYTES", 10)
    (tmp_path / "long.toml").write_text("textures = 'a.png'")
    with raises(PlanFileError, "file-unreadable"):
        read_scene_file(tmp_path / "long.toml")
