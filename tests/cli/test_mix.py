"""``uplift paints mix``."""

import matplotlib.image
import numpy as np
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import planes, read_channels, write_exr
from uplift.samples import sample_path

from .conftest import warning_lines

BLUE = "#005fa0"
YELLOW = "#ffd200"


def test_blue_and_yellow_are_green(ask):
    found = ask("paints mix --pigment", f"1:{BLUE}", f"1:{YELLOW}")
    red, green, blue = found["rgb"]
    assert green > 1.2 * max(red, blue)
    assert found["kind"] == "pigment"
    assert found["parts"] == [1, 1]
    assert len(found["wavelengths"]) == len(found["spectrum"]) == 81
    assert (found["ramp"][0]["hex"], found["ramp"][-1]["hex"]) == (BLUE, YELLOW)
    assert found["ramp"][4]["hex"] == found["hex"]
    assert ask("paints mix", BLUE, YELLOW) == found
    assert ask("paints mix", f"2:{BLUE}", f"1:{YELLOW}")["hex"] == "#538a51"
    alone = ask("paints mix", f"0:{BLUE}", f"2:{YELLOW}")
    assert (alone["names"], alone["hex"], alone["ramp"]) == ([YELLOW], YELLOW, [])


def test_entries_by_name_have_their_measured_spectra(ask, cubes, macbeth):
    cube = ("--cube", cubes / "moments-8-macbeth.uplift")
    from_cube = ask("paints mix '2:blue sky' yellow", *cube)
    measured = ask("paints mix '2:blue sky' yellow --atlas", macbeth)
    assert from_cube["names"] == measured["names"] == ["blue sky", "yellow"]
    assert_allclose(
        from_cube["spectrum"][4:], measured["spectrum"][4:], atol=0.03
    )  # from 400 nm
    plain = ask("paints mix 2:0.113,0.199,0.336 yellow --atlas", macbeth)
    assert np.abs(np.subtract(plain["spectrum"], measured["spectrum"])).max() > 0.03


def test_duntley_s_constants_from_files(ask):
    """Without thickness the ground shows; a paint mixed with itself is the same."""
    paint = str(sample_path("duntley.csv"))
    assert (
        ask("paints mix --thickness 0 --ground #f0e8d8 --duntley", paint)["hex"]
        == "#f0e8d8"
    )
    once, twice = (
        ask("paints mix --duntley", *words, "--ground", "black")
        for words in ((paint,), (f"2:{paint}", paint))
    )
    assert_allclose(once["spectrum"], twice["spectrum"])
    assert once["rgb"][0] > 3 * once["rgb"][2]


def test_lights_and_filters(run, ask):
    assert ask("paints mix --additive #ff0000 #00ff00")["hex"] == "#ffff00"
    (warning,) = warning_lines(run("paints mix --additive 3:#804020 3:#804020"))
    assert "(scale)" in warning
    once, twice = (ask("paints mix --filter", f"{x}:#ff8040")["rgb"] for x in (1, 2))
    assert all(np.less_equal(twice, once))


def test_swatches_are_plotted(run, refuse, home):
    run("paints mix", BLUE, YELLOW, "--plot", "green.png")
    picture = matplotlib.image.imread("green.png")
    last = (255 * picture[-40, -30, :3]).round().astype(int).tolist()
    assert last == [0xFF, 0xD2, 0x00]
    assert refuse("paints mix --plot green.png", BLUE).code == "file-exists"


def test_paint_over_an_image(run, refuse, home, cubes):
    rgb = np.random.default_rng(0).random((4, 5, 3)).astype(np.float32)
    write_exr(home / "in.exr", planes(rgb))
    options = ("--cube", cubes / "moments-8-macbeth.uplift", "--over", "in.exr")
    result = run("paints mix #c8342a", *options, "-o", "hidden.exr")
    assert result.stdout.startswith("hidden.exr: 20 pixels ")
    assert read_channels(home / "hidden.exr", "RGB").std(axis=(0, 1)).max() < 1e-4
    run("paints mix --dye #c8342a --thickness 0", *options, "-o", "bare.exr")
    assert_allclose(read_channels(home / "bare.exr", "RGB"), rgb, atol=1e-5)
    assert refuse("paints mix", BLUE, *options, "-o", "o.png").code == "output"
    assert (
        refuse("paints mix --additive", BLUE, *options, "-o", "o.exr").code == "option"
    )
