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


def test_choose(ask, home, macbeth):
    answer = ask("passes choose --count 1 --light D65 --atlas", macbeth)
    assert answer["count"] == 1
    assert answer["materials"]["held-out"] == 12
    assert answer["error"] < np.mean(answer["rgb"])
    stored = read_passes(home / "passes.toml")
    assert list(stored.bands.centres) == answer["centres"]


def test_choose_prints_errors(run, home):
    shown = run("passes choose --count 1 --light A --width 20 -o a.toml").stdout
    assert "alone" in shown
    assert read_passes(home / "a.toml").bands.width == 20


def test_choose_from_colours_of_an_image(ask, refuse, home):
    rng = np.random.default_rng(0)
    write(home / "a.exr", rng.random((8, 8, 3)).astype(np.float32))
    answer = ask("passes choose a.exr --count 1 --light D65")
    assert answer["materials"]["names"] == ["a.exr"]
    assert len(answer["materials"]["cube"]) == 64
    run_other = "texture a.exr --passes passes.toml -o b --cube ACEScg"
    assert refuse(run_other).code == "passes-of-another-cube"


@pytest.mark.parametrize(
    "words", ["--count 0", "--count 5", "--width -1", "--width 61"]
)
def test_choose_is_checked(misuse, words):
    assert words.split()[0] in misuse(f"passes choose {words}")


def test_a_cube_needs_images(misuse):
    assert "--cube" in misuse("passes choose --cube ACEScg")


def test_info(run, ask, passes):
    answer = ask("passes info passes.toml --light FL11 --light A")
    assert_allclose(answer["other_lights"]["A"], passes.light("A").numbers)
    assert len(answer["other_lights"]["FL11"]) == 6
    assert "FL11" in run("passes info passes.toml --light FL11").stdout


def test_texture_decode(run, ask, passes, home):
    """A texture lit by a light, as the picture of a renderer."""
    rng = np.random.default_rng(2)
    colours = rng.random((9, 8, 3)).astype(np.float32)
    write(home / "wood.exr", colours)
    run("texture wood.exr --passes passes.toml -o flat")
    light = passes.light("D65").numbers.astype(np.float32)
    for number in (1, 2):
        lit = pixels(home / f"flat.{number}.exr") * light[3 * number - 3 : 3 * number]
        write(home / f"lit.{number}.exr", lit.astype(np.float32))
    command = "passes decode lit.1.exr lit.2.exr --passes passes.toml -o lit.exr"
    answer = ask(command)
    assert answer == {"output": ["lit.exr"], "pixels": 72}
    assert np.abs(pixels(home / "lit.exr") - colours).max() < 0.05


def test_textures_of_several_images(run, passes, home):
    for name in ("a", "b"):
        write(home / f"{name}.exr", np.full((2, 3, 3), 0.5, np.float32))
    run("texture a.exr b.exr --passes passes.toml -o out")
    names = sorted(path.name for path in (home / "out").iterdir())
    assert names == ["a.1.exr", "a.2.exr", "b.1.exr", "b.2.exr"]
    again = run("texture a.exr b.exr --passes passes.toml -o out --resume")
    assert "4 skipped" in again.stdout
    run("lights texture a.exr --passes passes.toml -o sky")
    assert (pixels(home / "sky.2.exr") > 0).all()


@pytest.mark.parametrize(
    "words",
    [
        "texture a.exr -o b --passes passes.toml --representation moments",
        "texture a.exr -o b --passes passes.toml --wavelengths 400:700:10",
        "texture a.exr -o b --passes passes.toml --errors A",
        "texture a.exr -o b --passes passes.toml --mask m.png",
        "lights texture a.exr -o b --passes passes.toml --wavelengths 500",
        "lights query 1 1 1 --passes passes.toml --wavelengths 500",
        "query 1 1 1 --passes passes.toml --light A",
        "query 1 1 1 --passes passes.toml --plot",
        "query --passes passes.toml --check a.csv",
    ],
)
def test_options_that_exclude_passes(misuse, passes, words):
    assert "--passes" in misuse(words)


def test_query(run, ask, passes):
    grey, red = ask("query 0.5 0.5 0.5 '#ff0000' --passes passes.toml")
    assert_allclose(grey["passes"], 0.5, atol=0.03)
    assert np.shape(red["passes"]) == (2, 3)
    shown = run("query 0.5 0.5 0.5 --passes passes.toml").stdout
    assert "linear RGB" in shown
    rows = run("query 0.5 0.5 0.5 --passes passes.toml --format csv").stdout
    assert rows.splitlines()[0] == "r,g,b,pass,R,G,B"
    assert len(rows.splitlines()) == 3


def test_query_of_lights(ask, passes):
    (light,) = ask("lights query 2 2 2 --passes passes.toml")
    numbers = np.ravel(light["passes"])
    xyz = passes.to_xyz @ numbers
    assert_allclose(xyz, 2 * np.array([0.9505, 1, 1.089]), rtol=0.01)


def test_sequences(run, refuse, passes, home):
    for frame in (1, 2):
        for number in (1, 2):
            picture = np.full((2, 3, 3), 0.1 * frame, np.float32)
            write(home / f"a.{frame:04}.{number}.exr", picture)
    run("passes decode 'a.*.1.exr' 'a.*.2.exr' --passes passes.toml -o out")
    ratio = pixels(home / "out/a.0002.exr") / pixels(home / "out/a.0001.exr")
    assert_allclose(ratio, 2, rtol=1e-5)
    (home / "a.0002.2.exr").unlink()
    error = refuse("passes decode 'a.*.1.exr' 'a.*.2.exr' --passes passes.toml -o b")
    assert error.code == "frames-differ"


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("a.1.exr -o a.exr", "passes-missing"),
        ("a.1.exr a.2.exr -o a.png", "option"),
        ("a.1.exr a.2.exr -o a.1.exr --force", "output-is-input"),
        ("a.1.exr a.2.exr -o a.exr --light FL2", "unknown-name"),
        ("a.1.exr a.2.exr -o a.exr --space sRBG", "unknown-name"),
    ],
)
def test_decode_refuses(refuse, passes, home, words, code):
    for number in (1, 2):
        write(home / f"a.{number}.exr", np.full((2, 3, 3), 0.1, np.float32))
    assert refuse(f"passes decode --passes passes.toml {words}").code == code


@pytest.mark.parametrize("tool", ["text", "nuke", "blender"])
def test_recipe(run, passes, tool):
    shown = run(f"passes recipe passes.toml --for {tool} --space ACEScg").stdout
    assert len(shown.splitlines()) > 5
    if tool == "blender":
        compile(shown, "recipe", "exec")
