"""Contents of scene files, and the errors of invalid ones."""

import pytest

from tests.helpers import raises
from uplift.common.errors import PlanFileError
from uplift.extras.scene.plan.files import read_scene_file


@pytest.fixture
def read(tmp_path):
    """A function that reads a scene file of this text, next to a.png, b.1.exr, b.2.exr
    and c.txt.
    """
    for name in ("a.png", "b.1.exr", "b.2.exr", "c.txt"):
        (tmp_path / name).touch()

    def read(text):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return read_scene_file(path)

    return read


def test_all_keys_are_read(read, tmp_path):
    scene = read(
        'textures = ["a.png", "b.*.exr"]\natlases = "c.txt"\nlights = ["A", "FL11", '
        '"a"]\ntolerance = 2\n'
        'quantile = 0.9\nencoding = "linear"\nspace = "ITU-R BT.2020"\nilluminant = '
        '"D50"\n'
        'observer = "CIE 1964 10 Degree Standard Observer"'
    )
    assert [path.name for path in scene.textures] == ["a.png", "b.1.exr", "b.2.exr"]
    assert scene.atlases == (tmp_path / "c.txt",)
    assert (scene.lights, scene.tolerance, scene.quantile) == (("A", "FL11"), 2.0, 0.9)
    assert scene.encoding == "linear"
    sensor = scene.sensor()
    assert (sensor.space, sensor.illuminant) == ("ITU-R BT.2020", "D50")
    assert sensor.observer == "CIE 1964 10 Degree Standard Observer"


TEXTURES = "textures = 'a.png'\n"


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("lights = ['D65']", "textures"),
        ("\ntextures = [", ""),
        (TEXTURES + "\nlight = 'A'", "light"),
        ('textures = ["x\\u0000*"]', "textures[0]"),
        ("textures = '/etc/a.png'", "textures[0] must lie"),
        ("textures = ['a.png', 'b/../../a.png']", "textures[1]"),
        (TEXTURES + r"atlases = 'C:\c.txt'", "atlases[0] must lie"),
        (TEXTURES + "lights = ['D65', 'FL99']", "lights[1]"),
        (TEXTURES + "tolerance = nan", "tolerance"),
        (TEXTURES + '"a\\nb" = 3', "a\nb"),
        (TEXTURES + "illuminant = 'D66'", "illuminant"),
    ],
)
def test_an_invalid_file_is_refused_with_its_key(read, text, key):
    with raises(PlanFileError) as caught:
        read(text)
    error = caught.value
    assert error.path.name == "scene.toml"
    assert error.problem.startswith(key)
    assert len(error.problem) < 500
    assert "\n" not in str(error)
