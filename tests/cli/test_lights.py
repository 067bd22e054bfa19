"""``uplift lights``, and commands that need a cube."""

import json
import os
from functools import partial

import numpy as np
import OpenEXR
import pytest
from uplift_cli.output.diagnostics import hint_for

import uplift
from uplift.extras.emission.build import build_emission
from uplift.extras.emission.file import emission_digest


def test_a_light_has_its_colour_and_power_of_any_size(ask):
    found = ask("lights query 30 22 9")
    assert found["round_trip"]["rgb"] == pytest.approx([30, 22, 9], rel=1e-5)
    assert min(found["power"]) >= 0
    assert max(found["power"]) > 10
    assert 0 < found["expected_error"] < 10


def test_xyz_wavelengths_and_plot(run, home):
    words = "--xyz 0.9505 1 1.089 --wavelengths 400:700:100 --plot white.png"
    found = run(f"lights query {words} --format csv").stdout.splitlines()
    assert found[0].split(",")[-4:] == ["400", "500", "600", "700"]
    assert (home / "white.png").exists()
    for words in ("query 1 1 1", "texture in.exr -o out.exr"):
        assert (
            "0.4 µm are 400 nm"
            in run(f"lights {words} --wavelengths 0.4", code=2).stderr
        )


def test_colours_that_no_light_has(run):
    assert "--out-of-gamut clip" in run("lights query -1 1 -1", code=2).stderr
    assert "round trip" in run("lights query -1 1 -1 --out-of-gamut clip").stdout


def test_a_table_of_measured_lamps_is_built_and_queried(ask, run, home, monkeypatch):
    monkeypatch.setattr(
        "uplift.extras.emission.build.build_emission",
        partial(build_emission, knots=32, rings=4),
    )
    at = np.arange(400, 701, 10)
    power = np.exp(-(((at - 600) / 40) ** 2)) + 0.1
    values = ",".join(f"{value:.6g}" for value in power)
    (home / "lamps.csv").write_text(
        f"# spectral irradiance\nname,{','.join(map(str, at))}\nbulb,{values}\n"
    )
    assert "lamps" in run("lights build --atlas lamps.csv -o x.uplift").stdout
    table = uplift.load_emission("x.uplift")
    assert table.lamp_names[0] == "bulb"
    assert table.data.provenance["atlases"][0]["name"] == "lamps.csv"
    rgb = table.rgb(table.data.entries.spectra[0])
    words = "--lights x.uplift --format json --wavelengths 400:700:10 --"
    found = json.loads(
        run(f"lights query {words}", *map(str, 5 * rgb / rgb.max())).stdout
    )
    assert np.array(found["power"]) / max(found["power"]) == pytest.approx(
        power / power.max(), abs=1e-4
    )
    assert ask("lights info x.uplift")["lamps"][0] == "bulb"


def test_facts_and_picture(ask, run, home):
    table = uplift.load_emission()
    table.save(home / "lights.uplift")
    facts = ask("lights info lights.uplift")
    assert facts == ask("lights info")
    assert (facts["lamps"], facts["digest"]) == (
        list(table.lamp_names),
        emission_digest(table.data),
    )
    words = "--plot lights.png"
    assert "LED-B3" in run(f"lights info lights.uplift {words}").stdout
    assert (home / "lights.png").read_bytes().startswith(b"\x89PNG")
    assert "lights.png" in run(f"lights info {words}", code=2).stderr


def test_textures(run, home):
    pixels = np.full((2, 3), 1e5, np.float32)
    with OpenEXR.File(
        {"compression": OpenEXR.ZIP_COMPRESSION}, dict.fromkeys("RGB", pixels)
    ) as file:
        file.write(str(home / "sky.exr"))
    words = "lights texture sky.exr -o out.exr --wavelengths 450,550,650"
    assert run(words).output.startswith("out.exr: 1 texture, 6 pixels, 0.0 MB, ")
    found = OpenEXR.File("out.exr", separate_channels=True).channels()
    assert found["S0.550,000000nm"].pixels.min() > 1e4
    assert run(f"{words} --resume --lights emission").output.startswith(
        "out.exr: 0 textures"
    )


def test_programs(run, misuse, home):
    assert run("lights export -o lights.h").output.startswith("lights.h: ")
    assert "lights_power" in (home / "lights.h").read_text()
    assert "in b.bin" in run("lights export -o b.h --table file").output
    assert ".glsl" in misuse("lights export -o lights.wgsl")


@pytest.mark.parametrize("words", ["-o lights.glsl", "-o lights.h --table file"])
def test_no_output_replaces_the_table(refuse, home, words):
    uplift.load_emission().save(home / "lights.bin")
    assert refuse(f"lights export lights.bin {words} --force").code == "output-is-input"
    assert os.listdir(home) == ["lights.bin"]


@pytest.mark.parametrize(
    "words",
    [
        "query 1 1 1 --cube lights.uplift",
        "texture in.png -o out.exr --cube lights.uplift",
        "lab study sensitivity lights.uplift",
    ],
)
def test_commands_that_need_a_cube_name_the_commands_of_lights(refuse, home, words):
    uplift.load_emission().save(home / "lights.uplift")
    plain_image(home / "in.png")
    error = refuse(words)
    assert error.code == "not-a-cube"
    assert "uplift lights" in hint_for(error)


@pytest.mark.parametrize("words", ["query 1 1 1", "texture in.png -o out.exr"])
def test_cubes_are_not_lights(refuse, home, words):
    plain_image(home / "in.png")
    uplift.load().save(home / "cube.uplift")
    assert (
        refuse(f"lights {words} --lights cube.uplift").code == "not-an-emission-table"
    )


def plain_image(path):
    from matplotlib.image import imsave

    imsave(path, np.full((2, 2, 3), 128, dtype=np.uint8))
