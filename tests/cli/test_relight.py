"""``uplift relight`` and ``uplift samples``."""

import os
import re

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from uplift.samples import sample_names


@pytest.fixture
def wood(home):
    Image.fromarray(np.full((12, 20, 3), (180, 90, 40), np.uint8)).save(
        home / "wood.png"
    )
    return "wood.png"


def test_a_page_of_own_images_with_a_cube(ask, home, cubes, wood):
    cube = cubes / "moments-8-macbeth.uplift"
    words = (wood, wood, "--cube", cube, "--light", "A", "-o", "relit.html")
    differences = ask("relight", *words)["differences"]
    assert differences[1]["spectra"] == f"spectral with {cube.stem}"
    for row in differences:
        assert 0 < row["mean"] <= row["max"] + 1e-9
    assert (home / "relit.html").read_text("utf-8").count("<section") == 2


def test_the_sample_is_relit_with_its_atlas(run):
    assert "spectral with macbeth" in run("relight --light HP1 --no-adapt").stdout


def test_an_image_of_full_size_has_a_layer_for_each_further_light(ask, home, wood):
    found = ask("relight --light tungsten --light 3200K -o relit.exr", wood)
    assert found == {"output": "relit.exr", "lights": ["A", "3200K"], "pixels": 240}
    (part,) = OpenEXR.File(str(home / "relit.exr"), separate_channels=True).parts
    assert set(part.channels) == {*"RGB", *(f"3200K.{letter}" for letter in "RGB")}
    assert part.channels["R"].pixels.shape == (12, 20)


def test_samples_have_a_folder_and_may_be_copied_again(run, refuse, home):
    run("samples")
    run("samples")
    assert set(os.listdir(home / "uplift-samples")) == set(sample_names())
    (home / "uplift-samples" / "wood.png").write_text("mine")
    assert refuse("samples").code == "file-exists"
    run("samples --force")


def test_the_first_commands_with_samples_run_as_pasted(run):
    lines = re.findall("^  uplift (.*)", run("samples 'my samples'").stdout, re.M)
    assert len(lines) == 3
    for line in lines:
        assert run(line).stderr == ""
