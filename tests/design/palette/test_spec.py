"""Specs: what they mean, and what is said of faulty ones."""

from __future__ import annotations

import numpy as np
import pytest

import uplift
from tests.conftest import MACBETH, ROOT
from uplift.atlas import on_grid, read_atlas
from uplift.common.errors import AtlasError, PaletteError, UnknownNameError, UpliftError
from uplift.design.palette import read_palette
from uplift.design.palette.colours import screen_matrix
from uplift.design.palette.lights import planck
from uplift.design.palette.palette import MinDifference

WHOLE = f"""
smoothness = 0.002
model-error = 0.5
coefficients = 5

[lights]
day = {{ illuminant = "D65" }}
glow = {{ planck = 2856, luminance = 0.5 }}
odd = {{ design = true, bounds = [0, 3] }}

[materials]
orange = {{ atlas = "{MACBETH.as_posix()}", entry = "orange" }}
rose = {{ rgb = "#cc3366" }}
sea = {{ rgb = [0.1, 0.2, 0.3], cube = "{(ROOT / "cubes" / "moments-8.uplift").as_posix()}" }}
new = {{ design = true }}
wild = {{ design = true, bounds = false }}

[colours.new]
day = "#808080"
glow = {{ rgb = [0.3, 0.2, 0.1], weight = 2 }}

[colours.wild]
day = {{ free = "one" }}
glow = {{ free = "two", weight = 0 }}

[free.one]
low = "#101010"
high = [0.5, 0.6, 0.7]

[[apart]]
materials = ["new", "wild"]
light = "day"
delta-e = 4.5
"""


@pytest.fixture
def read(tmp_path):
    """A spec as text → palette."""

    def read(text):
        path = tmp_path / "spec.toml"
        path.write_text(text, encoding="utf-8")
        return read_palette(path)

    return read


def test_a_whole_spec(read, sensor):
    palette = read(WHOLE)
    assert (palette.smoothness, palette.model_error, palette.count) == (0.002, 0.5, 5)
    assert [part.name for part in palette.lights] == ["day", "glow", "odd"]
    assert [part.designed for part in palette.materials] == [False, False, False, True, True]
    odd, new, wild = palette.light("odd"), palette.material("new"), palette.material("wild")
    assert [(part.low, part.high) for part in (odd, new, wild)] == [(0, 3), (0, 1), (-np.inf, np.inf)]
    assert palette.min_differences == (MinDifference(("new", "wild"), "day", 4.5),)
    first, second, third, fourth = palette.goals
    np.testing.assert_allclose(first.rgb, sensor.decode([128] * 3))
    assert (second.rgb.tolist(), second.weight) == ([0.3, 0.2, 0.1], 2)
    assert (third.free, fourth.free, fourth.weight) == ("one", "two", 0)


def test_free_colours_are_what_a_screen_shows_if_nothing_else_is_said(read, sensor):
    free = read(WHOLE).free
    assert free["one"][1].tolist() == [0.5, 0.6, 0.7]
    np.testing.assert_allclose(free["one"][0], sensor.decode([16] * 3))
    assert [bound.tolist() for bound in free["two"]] == [[0] * 3, [1] * 3]


def test_given_spectra_are_what_their_sources_say(read, sensor):
    palette = read(WHOLE)
    orange = on_grid(read_atlas(MACBETH), sensor.wavelengths)[read_atlas(MACBETH).names.index("orange")]
    np.testing.assert_array_equal(palette.material("orange").samples, orange)
    cube = uplift.load()
    rose = cube.reflectance(cube.decode([0xCC, 0x33, 0x66]), sensor.wavelengths)
    np.testing.assert_array_equal(palette.material("rose").samples, rose)
    np.testing.assert_allclose(sensor.rgb(palette.material("sea").samples), [0.1, 0.2, 0.3], atol=1e-4)


def test_lights_have_the_luminance_asked_for(read, sensor):
    palette = read(WHOLE)
    seen = [sensor.xyz(screen_matrix(sensor) @ palette.light(name).samples)[1] for name in ("day", "glow")]
    np.testing.assert_allclose(seen, [1, 0.5], atol=1e-12)


def test_a_black_body_of_2856_k_is_illuminant_a(sensor):
    """The CIE defines A by Planck's law; its table has six digits."""
    from uplift.design.palette.lights import illuminant

    np.testing.assert_allclose(planck(sensor, 2855.5), illuminant(sensor, "A"), rtol=1e-3)


def test_paths_start_where_the_spec_lies(tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    (tmp_path / "paints.txt").write_bytes(MACBETH.read_bytes())
    spec = tmp_path / "sub" / "spec.toml"
    spec.write_text(
        'lights.day.illuminant = "D65"\nmaterials.x = { atlas = "../paints.txt", entry = "orange" }\n',
        encoding="utf-8",
    )
    monkeypatch.chdir("/")
    assert read_palette(spec).material("x").samples is not None


HEAD = 'lights.day.illuminant = "D65"\nmaterials.new.design = true\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("lights = [", "cannot be read: "),
        ("", r"\[lights\]: there are none; name at least one"),
        ("lights = 3", "'lights' is no table; write it as"),
        (HEAD + "smothness = 1", "unknown key 'smothness'; did you mean 'smoothness'"),
        (HEAD + "smoothness = -1", "'smoothness' is -1; write a number of at least 0"),
        (HEAD + "smoothness = true", "'smoothness' is True; write a number of at most"),
        (HEAD + "model-error = nan", "'model-error' is nan; write a number"),
        (HEAD + "coefficients = 6.5", "'coefficients' is 6.5; take 3 to 12"),
        (HEAD + "coefficients = 40", "'coefficients' is 40; take 3 to 12"),
        (HEAD + 'colours.ne.day = "#000000"', "unknown material 'ne'; did you mean 'new'"),
        (HEAD + 'colours.new.dya = "#000000"', "unknown light 'dya'; did you mean 'day'"),
        (HEAD + 'colours.new.day = "red"', "'day' is 'red', no colour; write '#cc3319'"),
        (HEAD + 'colours.new.day = "#gg0000"', "no colour"),
        (HEAD + "colours.new.day = [1, 2]", "no colour"),
        (HEAD + "colours.new.day = [1, 2, true]", "no colour"),
        (HEAD + "colours.new.day = [1, 2, inf]", "no colour"),
        (HEAD + "colours.new.day = { weight = 2 }", "'rgb' is missing; add it"),
        (HEAD + 'colours.new.day = { free = "a", rgb = "#000000" }', "unknown key 'rgb'"),
        (HEAD + 'free.a = { low = "#808080", high = "#80ffff" }', "'low' is not below 'high'"),
        (HEAD + "smoothness = 1" + "0" * 400, "'smoothness' is 10.*; write a number of at most 1,000,000"),
        (HEAD + "colours.new.day = [1e9, 0, 0]", "no colour"),
        (HEAD + "materials.x = { design = true, bounds = [0, 1e9] }", r"write \[low, high\] or false"),
        (HEAD + "materials.'$x' = { design = true }", r"\[materials\]: '\$x' is no name; write letters"),
        (HEAD + 'colours.new.day = { free = "" }', "'' is no name"),
        (HEAD + "apart = 3", "no list of tables; write each as"),
        (HEAD + '[[apart]]\nmaterials = ["new"]\nlight = "day"', "write a list of 2 names"),
        (HEAD + "materials.x.design = false", "'design' is False; write design = true or leave it out"),
        (HEAD + "materials.x = { design = true, bounds = [1, 0] }", r"write \[low, high\] or false"),
        (HEAD + "materials.x = { design = true, bounds = true }", r"write \[low, high\] or false"),
        (HEAD + "materials.x = { }", "is given by nothing; give it by one of atlas, rgb, design"),
        (HEAD + 'materials.x = { design = true, rgb = "#000000" }', "is given by 'rgb' and 'design'"),
        (HEAD + "materials.x = 4", "'x' is no table"),
        (HEAD + 'lights.x = { planck = "hot" }', "'planck' is 'hot'; write a number"),
        (HEAD + "lights.x = { planck = 3 }", "a black body of 3 K; give a temperature of"),
        (HEAD + "lights.x = { planck = 3000, luminance = -1 }", "'luminance' is -1"),
        (
            HEAD + f'materials.x = {{ atlas = "{MACBETH.as_posix()}", entry = "orang" }}',
            "did you mean 'orange'",
        ),
    ],
)
def test_faults_are_told_with_a_remedy(read, text, message):
    with pytest.raises(UpliftError, match=message):
        read(text)


def test_what_other_files_lack_is_told_by_them(read):
    with pytest.raises(UnknownNameError, match="unknown illuminant 'D66'"):
        read(HEAD + 'lights.x.illuminant = "D66"')
    with pytest.raises(AtlasError, match="cannot be read"):
        read(HEAD + 'materials.x = { atlas = "none.txt", entry = "a" }')


@pytest.mark.parametrize("content", [b"\xff\xfe", b"x = " + b"[" * 50_000, None])
def test_files_that_are_no_text_are_told(tmp_path, content):
    path = tmp_path / "spec.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(PaletteError, match=r"cannot be read: .*; write a spec in TOML"):
        read_palette(path)
