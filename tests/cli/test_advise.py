"""``uplift advise``, and textures with standard errors."""

import json

import matplotlib.image
import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import without_evidence
from uplift.samples import sample_path


def test_command_prints_and_draws_its_advice(run, ask, refuse, cubes, home):
    file = cubes / "moments-16-macbeth.uplift"
    wood = sample_path("wood.png")
    found = ask(
        "advise",
        wood,
        "--cube",
        file,
        "--light",
        "FL11",
        "--count",
        2,
        "--plot",
        "a.png",
    )
    assert list(found["lights"]) == ["FL11"]
    first, second = found["swatches"]
    errors = {stage: each["mean"] for stage, each in found["lights"]["FL11"].items()}
    assert first["gain"] > second["gain"] > 0
    assert errors["before"] - first["gain"] == pytest.approx(first["mean_after"])
    assert second["mean_after"] == pytest.approx(errors["after"])
    assert matplotlib.image.imread("a.png").shape[1] > 500
    assert (
        first["hex"]
        in run("advise", wood, "--cube", file, "--light", "FL11", "--count", 2).stdout
    )
    assert (
        refuse("advise", wood, "--cube", file, "--plot", "a.png").code == "file-exists"
    )


def test_textures_have_the_standard_errors_of_their_pixels(run, refuse, cubes, home):
    file = cubes / "moments-16-macbeth.uplift"
    source = sample_path("wood.png")
    arguments = ("--representation", "moments", "--depth", "float", "--errors", "FL11")
    run("texture", source, "-o", "a.exr", "--cube", file, *arguments)
    texture = OpenEXR.File("a.exr", separate_channels=True)
    channels = {name: each.pixels for name, each in texture.channels().items()}
    rgb = np.stack([channels[name] for name in "RGB"], axis=-1)
    expected = uplift.load(file).standard_error(rgb, "FL11")
    assert_allclose(channels["error.FL11"], expected, atol=1e-3)
    assert json.loads(texture.header()["uplift.texture"])["errors"] == ["FL11"]
    without_evidence(uplift.load()).save(home / "old.uplift")
    masked = ("--mask", sample_path("mask.png"), "--cube", file, "--cube", file)
    assert (
        refuse("texture", source, "-o", "b.exr", *masked, *arguments).code == "option"
    )
    assert (
        refuse(
            "texture", source, "-o", "b.exr", "--cube", home / "old.uplift", *arguments
        ).code
        == "too-few-entries"
    )


def test_second_lights_are_ranked(run, ask, refuse, misuse, cubes, home):
    wood = sample_path("wood.png")
    names = ("--candidate", "A", "--candidate", "led", "--light", "FL11")
    found = ask("advise", wood, "--second-light", *names)
    assert found["noise"] == {"share": 0.005, "floor": 0.0005}
    means = [row["mean"] for row in found["second_lights"]]
    assert means == sorted(means)
    assert found["without"]["mean"] > means[-1]
    assert {row["light"] for row in found["second_lights"]} == {"A", "LED-B3"}
    assert all(list(row["errors"]) == ["FL11"] for row in found["second_lights"])
    table = run("advise", wood, "--second-light", "--cube", cubes / "moments-8.uplift")
    assert "LED-RGB1" in table.stdout
    second = ("advise", wood, "--second-light")
    assert refuse(*second, "--candidate", "D65").code == "option"
    assert refuse(*second, "--candidate", "none").code == "unknown-name"
    assert refuse(*second, "--noise", "-1").code == "option"
    assert "--count" in misuse(*second, "--count", 3)
    assert ask("advise", wood)["swatches"]
    assert "--candidate" in misuse("advise", wood, "--candidate", "A")
