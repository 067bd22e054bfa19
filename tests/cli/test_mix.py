"""``uplift paints mix``."""

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
    ramp = [colour["hex"] for colour in found["ramp"]]
    assert [ramp[0], ramp[4], ramp[-1]] == [BLUE, found["hex"], YELLOW]
    assert ask("paints mix --plot green.png", BLUE, YELLOW) == found
    assert ask("paints mix", f"2:{BLUE}", f"1:{YELLOW}")["hex"] == "#548a51"
    alone = ask("paints mix", f"0:{BLUE}", f"2:{YELLOW}")
    assert (alone["names"], alone["hex"]) == ([YELLOW], YELLOW)


def test_entries_by_name_have_their_measured_spectra(ask, cubes, macbeth):
    words = "paints mix '2:blue sky' yellow"
    from_cube = ask(words, "--cube", cubes / "moments-8-macbeth.uplift")["spectrum"]
    measured = ask(words, "--atlas", macbeth)["spectrum"]
    assert_allclose(from_cube[4:], measured[4:], atol=0.03)  # from 400 nm


def test_duntley_s_constants_from_files(ask):
    """Without thickness the ground shows; a paint mixed with itself is the same."""
    paint = str(sample_path("duntley.csv"))
    bare = ask("paints mix --thickness 0 --ground #f0e8d8 --duntley", paint)
    assert bare["hex"] == "#f0e8d8"
    once = ask("paints mix --duntley --ground black", paint)
    twice = ask("paints mix --duntley --ground black", f"2:{paint}", paint)
    assert_allclose(once["spectrum"], twice["spectrum"])


def test_lights_and_filters(run, ask):
    assert ask("paints mix --additive #ff0000 #00ff00")["hex"] == "#ffff00"
    (warning,) = warning_lines(run("paints mix --additive 3:#804020 3:#804020"))
    assert "(scale)" in warning
    once, twice = (ask("paints mix --filter", f"{x}:#ff8040")["rgb"] for x in (1, 2))
    assert all(np.less_equal(twice, once))


def test_paint_over_an_image(run, home, cubes):
    rgb = np.random.default_rng(0).random((4, 5, 3)).astype(np.float32)
    write_exr(home / "in.exr", planes(rgb))
    options = ("--cube", cubes / "moments-8-macbeth.uplift", "--over", "in.exr")
    run("paints mix #c8342a", *options, "-o", "hidden.exr")
    assert read_channels(home / "hidden.exr", "RGB").std(axis=(0, 1)).max() < 1e-4
    run("paints mix --dye #c8342a --thickness 0", *options, "-o", "bare.exr")
    assert_allclose(read_channels(home / "bare.exr", "RGB"), rgb, atol=1e-5)
