"""``uplift relight`` and ``uplift samples``."""

import os
import shlex

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
    found = ask(
        "relight", wood, wood, "--cube", cube, "--light", "A", "-o", "relit.html"
    )
    assert found["output"] == "relit.html"
    assert [row["spectra"] for row in found["differences"][:2]] == [
        "spectral",
        f"spectral with {cube.stem}",
    ]
    assert all(0 < row["mean"] <= row["max"] + 1e-9 for row in found["differences"])
    assert (home / "relit.html").read_text("utf-8").count("<section") == 2


def test_the_sample_is_relit_with_its_atlas(run, home):
    result = run("relight --light HP1")
    assert "spectral with macbeth" in result.stdout
    assert result.stdout.rstrip().endswith("relit.png: still-life.png under HP1")
    with Image.open(home / "relit.png") as image:
        assert image.width > 1000


def test_an_image_of_full_size_has_a_layer_for_each_further_light(
    ask, misuse, home, wood
):
    found = ask("relight --light tungsten --light 3200K -o relit.exr", wood)
    assert found == {"output": "relit.exr", "lights": ["A", "3200K"], "pixels": 240}
    (part,) = OpenEXR.File(str(home / "relit.exr"), separate_channels=True).parts
    assert set(part.channels) == {*"RGB", *(f"3200K.{letter}" for letter in "RGB")}
    assert part.channels["R"].pixels.shape == (12, 20)
    assert "one by one" in misuse("relight", wood, wood, "-o", "both.exr")


@pytest.mark.parametrize(
    ("option", "balanced"),
    [("--adapt", "[true, true]"), ("--no-adapt", "[false, false]")],
)
def test_lights_are_shown_white_or_tinted(ask, home, wood, option, balanced):
    ask("relight", wood, "--light", "A", "--light", "HP1", option, "-o", "relit.html")
    page = (home / "relit.html").read_text(encoding="utf-8")
    assert f'"balanced": {balanced}' in page


def test_samples_have_a_folder_and_may_be_copied_again(run, refuse, home):
    assert run("samples").stdout == run("samples").stdout
    assert set(os.listdir(home)) == {"uplift-samples"}
    assert set(os.listdir(home / "uplift-samples")) == set(sample_names())
    (home / "uplift-samples" / "wood.png").write_text("mine")
    assert refuse("samples").code == "file-exists"
    run("samples --force")


@pytest.mark.parametrize("folder", ["uplift-samples", ".", "my samples"])
def test_the_first_commands_with_samples_run_as_pasted(run, folder):
    lines = [
        line
        for line in run("samples", folder).stdout.splitlines()
        if line.startswith("  uplift ")
    ]
    assert len(lines) == 3
    for line in lines:
        assert run(*shlex.split(line)[1:]).stderr == ""
