"""Files of lamps in place of the names of lights, in every command that takes them."""

import os
import shutil

import numpy as np
import OpenEXR
import pytest

from uplift.colorimetry.observer import illuminant_spd

from .conftest import warning_lines

LAMP = "\n".join(
    f"{nm}\t{power:.5f}"
    for nm, power in zip(range(380, 781, 5), np.linspace(1, 5, 81), strict=True)
)
COMMANDS = """
advise wood.png --cube cube.uplift --light {}
advise wood.png --second-light --light {} --candidate led
advise wood.png --second-light --light FL11 --candidate {}
atlas macbeth --illuminant {}
lab bounds #888 --cube cube.uplift --light {}
lab bounds #888 --cube cube.uplift --light {} --html x.html --plot x.png
query #888 --cube cube.uplift --also {}:#998877
passes info passes.toml --light {}
build --atlas macbeth --dim 3 --light {} -o x.uplift
lab compare --atlas macbeth --write PS16 --light {} -o out
lab diff cube.uplift cube.uplift --light {}
export cube.uplift -o x.cube --light {}
export cube.uplift -o x.npy --res 8 --light {}
query #888 --cube cube.uplift --light {}
relight wood.png --cube cube.uplift --light {} -o x.html
relight wood.png --cube cube.uplift --light {} -o x.exr
report cube.uplift --light {} -o x.html
texture wood.png -o x.exr --cube cube.uplift --errors {}
lab wavelengths --count 3 --atlas macbeth --light {} --illuminant {}
"""
"""Commands with a light; {} is its name or file."""
WITHOUT_JSON = ("build", "compare", "export", "report", "texture")


@pytest.fixture
def files(home, repository, cubes, passes_text):
    shutil.copy(repository / "uplift" / "samples" / "files" / "wood.png", home)
    shutil.copy(cubes / "moments-8-macbeth.uplift", home / "cube.uplift")
    (home / "passes.toml").write_text(passes_text)
    (home / "lamp.spd").write_text(LAMP)
    (home / "card.csv").write_text(
        "wavelength,reflectance\n400,0.1\n500,0.2\n700,0.3\n"
    )
    (home / "empty.spd").write_text("")
    (home / "folder").mkdir()
    (home / "two.csv").write_text("name,400,550,700\ncold,3,2,1\nwarm,1,2,3\n")
    return set(os.listdir(home))


@pytest.mark.parametrize("line", COMMANDS.strip().splitlines())
def test_every_light_may_be_a_file(run, refuse, home, files, line):
    for name, code in (
        ("card.csv", "not-a-lamp"),
        ("empty.spd", "atlas"),
        ("./folder", "file-unreadable"),
        ("two.csv", "atlas"),
        ("two.csv:none", "unknown-name"),
        ("none.spd", "unknown-name"),
    ):
        assert refuse(line.replace("{}", name)).code == code
    assert set(os.listdir(home)) == files
    words = line.replace("{}", "lamp.spd").split()
    is_json = not line.removeprefix("lab ").startswith(WITHOUT_JSON)
    result = run(*words, *["--format", "json"] * is_json)
    assert not is_json or '"lamp"' in result.stdout


def test_a_texture_names_its_lamp_and_a_changed_lamp_is_another_texture(
    run, refuse, home, files
):
    words = "texture wood.png -o x.exr --cube cube.uplift --errors lamp.spd --resume"
    run(words)
    with OpenEXR.File(str(home / "x.exr"), separate_channels=True) as file:
        assert "error.lamp" in file.channels()
    run(words)
    (home / "lamp.spd").write_text(LAMP.replace("780\t5", "780\t4"))
    assert refuse(words).code == "texture-differs"


def test_a_cube_is_not_built_under_a_lamp(refuse, files):
    assert refuse("build --dim 3 --illuminant lamp.spd").code == "option"


def test_two_lights_of_one_name(refuse, home, files):
    (home / "folder" / "lamp.spd").write_text(LAMP.replace("780\t5", "780\t4"))
    for line in COMMANDS.strip().splitlines():
        if "--light" in line and "export" not in line:
            words = line.replace("{}", "lamp.spd", 1).replace("{}", "A").split()
            error = refuse(*words, "--light", "folder/lamp.spd")
            assert error.code == "option", line


def test_passes_know_a_lamp_by_its_spectrum(run, ask, home, files):
    """The lamp of the passes has the spectrum of A."""
    passes = home / "passes.toml"
    passes.write_text(passes.read_text().replace('name = "A"', 'name = "lamp"'))
    rows = np.column_stack([np.arange(300, 831, 5), illuminant_spd("A", 300, 830, 5)])
    np.savetxt(home / "folder" / "lamp.spd", rows, "%.17g")
    shown = ask("passes info passes.toml --light folder/lamp.spd")
    assert shown["other_lights"]["lamp"] == shown["lights"]["lamp"]["numbers"]
    (warning,) = warning_lines(run("passes info passes.toml --light lamp.spd"))
    assert "another spectrum" in warning


def test_scenes_name_lamps(ask, refuse, home, files):
    scene = home / "scene.toml"
    scene.write_text(
        'textures = ["wood.png"]\natlases = ["two.csv"]\nlights = ["lamp.spd", '
        '"A"]\ntolerance = 0.5\n'
    )
    (home / "two.csv").write_text(
        "name,400,550,700\ncold,0.3,0.2,0.1\nwarm,0.1,0.2,0.3\n"
    )
    plan = ask("plan scene.toml --quick")
    assert plan["scene"]["lights"] == ["lamp", "A"]
    assert refuse("plan scene.toml -o lamp.spd --force").code == "output-is-input"
    for lights in ('"card.csv"', '"none.spd"', '"../lamp.spd"', '"folder"', "3"):
        scene.write_text(f'textures = ["wood.png"]\nlights = [{lights}]\n')
        assert refuse("plan scene.toml -o x.json").where == "scene.toml"


def test_palettes_name_lamps(ask, refuse, home, files):
    text = (
        "[materials]\ncard = {{rgb = [0.5, 0.5, 0.5]}}\n[lights]\nday = {{illuminant "
        '= "{}"}}\n'
    )
    palette = home / "palette.toml"
    for name in ("lamp.spd", "two.csv:warm"):
        palette.write_text(text.format(name))
        assert ask("lab palette palette.toml")
        file = name.partition(":")[0]
        error = refuse("lab palette palette.toml --force -o", file)
        assert error.code == "output-is-input"
    for name in ("card.csv", "none.spd", "../lamp.spd", "two.csv", "D66"):
        palette.write_text(text.format(name))
        refuse("lab palette palette.toml -o x.csv")
