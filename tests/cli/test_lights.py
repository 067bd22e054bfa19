"""``uplift lights``, and commands that need a cube."""

from functools import partial

import numpy as np
import OpenEXR
import pytest
from uplift_cli.output.diagnostics import hint_for

import uplift
from tests.extras.texture.conftest import planes, write_exr
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
    assert "round trip" in run("lights query -1 1 -1 --out-of-gamut clip").stdout


def test_a_table_of_measured_lamps_is_built_and_queried(ask, run, home, monkeypatch):
    monkeypatch.setattr(
        "uplift.extras.emission.build.build_emission",
        partial(build_emission, knots=32, rings=4),
    )
    at = np.arange(400, 701, 10)
    power = np.exp(-(((at - 600) / 40) ** 2)) + 0.1
    rows = "".join(f"{nm}\t{value:.6g}\n" for nm, value in zip(at, power, strict=True))
    (home / "bulb.spd").write_text(rows)
    run("lights build --atlas bulb.spd -o x.uplift")
    table = uplift.load_emission("x.uplift")
    assert table.lamp_names[0] == "bulb"
    rgb = table.rgb(table.data.entries.spectra[0])
    words = "lights query --lights x.uplift --wavelengths 400:700:10"
    found = np.array(ask(words, *5 * rgb / rgb.max())["power"])
    assert found / found.max() == pytest.approx(power / power.max(), abs=1e-4)


def test_facts_and_picture(ask, run, home):
    table = uplift.load_emission()
    table.save(home / "lights.uplift")
    facts = ask("lights info lights.uplift")
    assert facts == ask("lights info")
    assert facts["lamps"] == list(table.lamp_names)
    assert facts["digest"] == emission_digest(table.data)
    assert "LED-B3" in run("lights info lights.uplift --plot lights.png").stdout


def test_textures(run, home):
    write_exr(home / "sky.exr", planes(np.full((2, 3, 3), 1e5, np.float32)))
    words = "lights texture sky.exr -o out.exr --wavelengths 450,550,650"
    assert run(words).output.startswith("out.exr: 1 texture, 6 pixels, 0.0 MB, ")
    found = OpenEXR.File("out.exr", separate_channels=True).channels()
    assert found["S0.550,000000nm"].pixels.min() > 1e4
    resumed = run(f"{words} --resume --lights emission").output
    assert resumed.startswith("out.exr: 0 textures")


def test_programs(run, home):
    run("lights export -o lights.h")
    assert "lights_power" in (home / "lights.h").read_text()
    assert "in b.bin" in run("lights export -o b.h --table file").output


@pytest.mark.parametrize(
    "words",
    [
        "query 1 1 1 --cube lights.uplift",
        "texture in.exr -o out.exr --cube lights.uplift",
        "lab study sensitivity lights.uplift",
    ],
)
def test_commands_that_need_a_cube_name_the_commands_of_lights(refuse, home, words):
    uplift.load_emission().save(home / "lights.uplift")
    write_exr(home / "in.exr", planes(np.full((2, 2, 3), 0.5, np.float32)))
    error = refuse(words)
    assert error.code == "not-a-cube"
    assert "uplift lights" in hint_for(error)
