"""``uplift passes``, and --passes of other commands."""

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

from uplift.extras.scene.passes.file import read_passes


@pytest.fixture
def passes(home, passes_text):
    """Two passes in the working folder."""
    (home / "passes.toml").write_text(passes_text)
    return read_passes(home / "passes.toml")


def write(path, rgb, **header):
    channels = dict(zip("RGB", np.moveaxis(rgb, -1, 0).copy(), strict=True))
    OpenEXR.File(header, channels).write(str(path))


def pixels(path):
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return np.stack([channels[name].pixels for name in "RGB"], axis=-1)


def test_choose(run, ask, home, macbeth):
    words = ("passes choose --count 1 --light D65 --atlas", macbeth)
    answer = ask(*words)
    assert answer["count"] == 1
    assert answer["materials"]["held-out"] == 12
    assert answer["error"] < np.mean(answer["rgb"])
    stored = read_passes(home / "passes.toml")
    assert list(stored.bands.centres) == answer["centres"]
    assert "alone" in run(*words, "--force", "--width", 20).stdout
    assert read_passes(home / "passes.toml").bands.width == 20


def test_choose_from_colours_of_an_image(ask, refuse, home):
    rng = np.random.default_rng(0)
    write(home / "a.exr", rng.random((8, 8, 3)).astype(np.float32))
    answer = ask("passes choose a.exr --count 1 --light D65")
    assert answer["materials"]["names"] == ["a.exr"]
    assert len(answer["materials"]["cube"]) == 64
    words = "texture a.exr --passes passes.toml -o b --cube ACEScg"
    assert refuse(words).code == "passes-of-another-cube"


def test_info(run, ask, passes):
    answer = ask("passes info passes.toml --light FL11 --light A")
    assert_allclose(answer["other_lights"]["A"], passes.light("A").numbers)
    assert len(answer["other_lights"]["FL11"]) == 6
    assert "FL11" in run("passes info passes.toml --light FL11").stdout


def test_texture_decode(run, passes, home):
    """A texture lit by a light, as the picture of a renderer."""
    colours = np.random.default_rng(2).random((9, 8, 3)).astype(np.float32)
    write(home / "wood.exr", colours)
    run("texture wood.exr --passes passes.toml -o flat")
    light = passes.light("D65").numbers.astype(np.float32)
    for number, lamp in ((1, light[:3]), (2, light[3:])):
        write(home / f"lit.{number}.exr", pixels(home / f"flat.{number}.exr") * lamp)
    run("passes decode lit.1.exr lit.2.exr --passes passes.toml -o lit.exr")
    assert np.abs(pixels(home / "lit.exr") - colours).max() < 0.05


def test_textures_of_several_images(run, passes, home):
    for name in ("a", "b"):
        write(home / f"{name}.exr", np.full((2, 3, 3), 0.5, np.float32))
    run("texture a.exr b.exr --passes passes.toml -o out --processes 1")
    names = sorted(path.name for path in (home / "out").iterdir())
    assert names == ["a.1.exr", "a.2.exr", "b.1.exr", "b.2.exr"]
    run("lights texture a.exr --passes passes.toml -o sky")
    assert (pixels(home / "sky.2.exr") > 0).all()


def test_query(run, ask, passes):
    grey, red = ask("query 0.5 0.5 0.5 '#ff0000' --passes passes.toml")
    assert_allclose(grey["passes"], 0.5, atol=0.03)
    assert np.shape(red["passes"]) == (2, 3)
    assert "linear RGB" in run("query 0.5 0.5 0.5 --passes passes.toml").stdout
    rows = run("query 0.5 0.5 0.5 --passes passes.toml --format csv").stdout
    heading, *lines = rows.splitlines()
    assert heading == "r,g,b,pass,R,G,B"
    assert len(lines) == 2


def test_query_of_lights(ask, passes):
    (light,) = ask("lights query 2 2 2 --passes passes.toml")
    xyz = passes.to_xyz @ np.ravel(light["passes"])
    assert_allclose(xyz, [1.901, 2, 2.178], rtol=0.01)


def test_sequences(run, passes, home):
    for name, value in (("1.1", 0.1), ("1.2", 0.1), ("2.1", 0.2), ("2.2", 0.2)):
        write(home / f"a.{name}.exr", np.full((2, 3, 3), value, np.float32))
    run("passes decode 'a.*.1.exr' 'a.*.2.exr' --passes passes.toml -o out")
    ratio = pixels(home / "out/a.2.exr") / pixels(home / "out/a.1.exr")
    assert_allclose(ratio, 2, rtol=1e-5)


@pytest.mark.parametrize("tool", ["text", "nuke", "blender"])
def test_recipe(run, passes, tool):
    shown = run(f"passes recipe passes.toml --for {tool} --space ACEScg").stdout
    assert len(shown.splitlines()) > 5
    if tool == "blender":
        compile(shown, "recipe", "exec")
