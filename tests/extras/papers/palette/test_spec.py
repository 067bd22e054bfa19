"""Contents of palette specs, and the errors of invalid ones."""

import shutil

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import MACBETH, ROOT
from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.common.errors import PaletteError
from uplift.extras.papers.palette.colours import illuminant, planck, screen_matrix
from uplift.extras.papers.palette.palette import MinDifference
from uplift.extras.papers.palette.spec import read_palette

COMPLETE = """
smoothness = 0.002
model-error = 0.5
coefficients = 5

[lights]
day = { illuminant = "D65" }
glow = { planck = 2856, luminance = 0.5 }
odd = { design = true, bounds = [0, 3] }

[materials]
orange = { atlas = "macbeth.txt", entry = "orange" }
rose = { rgb = "#cc3366" }
sea = { rgb = [0.1, 0.2, 0.3], cube = "cube.uplift" }
new = { design = true }
wild = { design = true, bounds = false }

[colours.new]
day = "#808080"
glow = { rgb = [0.3, 0.2, 0.1], weight = 2 }

[colours.wild]
day = { free = "one" }
glow = { free = "two", weight = 0 }

[free.one]
low = "#101010"
high = [0.5, 0.6, 0.7]

[[apart]]
materials = ["new", "wild"]
light = "day"
delta-e = 4.5
"""


HEAD = 'lights.day.illuminant = "D65"\nmaterials.new.design = true\n'


@pytest.fixture
def read(tmp_path):
    """A spec as text, next to an atlas and a cube → palette."""
    shutil.copy(MACBETH, tmp_path)
    shutil.copy(ROOT / "cubes" / "moments-8.uplift", tmp_path / "cube.uplift")

    def read(text):
        path = tmp_path / "spec.toml"
        path.write_text(text, encoding="utf-8")
        return read_palette(path)

    return read


def test_a_complete_spec(read, sensor):
    palette = read(COMPLETE)
    assert (palette.smoothness, palette.model_error, palette.count) == (0.002, 0.5, 5)
    parts = (*palette.lights, *palette.materials)
    assert {part.name: (part.low, part.high) for part in parts if part.designed} == {
        "odd": (0, 3),
        "new": (0, 1),
        "wild": (-np.inf, np.inf),
    }
    assert palette.min_differences == (MinDifference(("new", "wild"), "day", 4.5),)
    first, second, third, fourth = palette.goals
    assert_allclose(first.rgb, sensor.decode([128] * 3))
    assert (second.rgb.tolist(), second.weight) == ([0.3, 0.2, 0.1], 2)
    assert (third.free, fourth.free, fourth.weight) == ("one", "two", 0)
    assert_allclose(palette.free["one"], [sensor.decode([16] * 3), [0.5, 0.6, 0.7]])
    assert_array_equal(palette.free["two"], [[0] * 3, [1] * 3])


def test_given_spectra_are_those_of_their_sources(read, sensor):
    palette = read(COMPLETE)
    atlas = read_atlas(MACBETH)
    cube = uplift.load()
    orange = on_grid(atlas, sensor.wavelengths)[atlas.names.index("orange")]
    assert_array_equal(palette.material("orange").samples, orange)
    rose = cube.reflectance(cube.decode([0xCC, 0x33, 0x66]), sensor.wavelengths)
    assert_array_equal(palette.material("rose").samples, rose)
    sea = sensor.rgb(palette.material("sea").samples)
    assert_allclose(sea, [0.1, 0.2, 0.3], atol=1e-4)


def test_lights_have_their_luminance_or_their_norm(read, sensor):
    """The norm is the root mean square: 1 for a flat power of 1."""
    palette = read(
        HEAD
        + "lights.a = { planck = 2856, luminance = 0.5 }\n"
        + 'lights.b = { illuminant = "E", norm = 2 }'
    )
    luminances = [
        sensor.xyz(screen_matrix(sensor) @ palette.light(name).samples)[1]
        for name in ("day", "a")
    ]
    assert_allclose(luminances, [1, 0.5], atol=1e-12)
    assert_allclose(palette.light("b").samples, 2, rtol=1e-9)


def test_a_black_body_of_2856_k_is_illuminant_a(sensor):
    """The CIE defines A by Planck's law; its table has six digits."""
    assert_allclose(planck(sensor, 2855.5), illuminant(sensor, "A"), rtol=1e-3)


@pytest.mark.parametrize(
    ("text", "code", "key"),
    [
        ("lights = [", "invalid-file", ""),
        ("", "invalid-file", "lights"),
        (HEAD + "smothness = 1", "invalid-file", "smothness"),
        (HEAD + 'colours.ne.day = "#000000"', "unknown-name", "colours.ne"),
        (HEAD + 'colours.new.day = "red"', "colour", "colours.new.day"),
        (
            HEAD + 'colours.new.day = { free = "a", rgb = "#000000" }',
            "invalid-file",
            "colours.new.day.rgb",
        ),
        (
            HEAD + "materials.x = { design = true, bounds = [1, 0] }",
            "invalid-file",
            "materials.x.bounds",
        ),
        (
            HEAD + 'materials.x = { design = true, rgb = "#000000" }',
            "invalid-file",
            "materials.x",
        ),
        (
            HEAD + "lights.x = { planck = 3000, luminance = 1, norm = 1 }",
            "invalid-file",
            "lights.x",
        ),
        (HEAD + 'lights.x.illuminant = "D66"', "unknown-name", "lights.x.illuminant"),
        (
            HEAD + '[[apart]]\nmaterials = ["new"]\nlight = "day"',
            "invalid-file",
            "apart[0].materials",
        ),
    ],
)
def test_an_invalid_spec_is_refused_with_its_key(read, text, code, key):
    with raises(PaletteError, code) as caught:
        read(text)
    assert caught.value.problem.startswith(key)
    assert caught.value.path.name == "spec.toml"
