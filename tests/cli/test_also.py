"""``--also``: further photographs, under other lights."""

import os

import numpy as np
import pytest

import uplift
from tests.extras.texture.conftest import channels, planes, write_exr
from uplift.extras.photographs.answers import prepare
from uplift.extras.photographs.photograph import photograph
from uplift.samples import sample_path


@pytest.fixture
def wood(home):
    return sample_path("wood.png")


def test_a_colour_under_two_lights(run, ask):
    text = run("query #8a2a20 --also A:#9a2a22 --light HP1").stdout
    assert "also under" in text
    answer = ask("query 0.25 0.02 0.01 --also A:0.32,0.021,0.012")
    cube = uplift.load()
    prepared = prepare(cube, [photograph(cube.data.sensor, "A")])
    expected = prepared.reflectance([0.25, 0.02, 0.01], [0.32, 0.021, 0.012])
    assert answer["reflectance"] == pytest.approx(expected.tolist(), abs=1e-9)
    assert answer["also"] == {"A": [0.32, 0.021, 0.012]}
    assert not answer["contradicts"]
    plain = ask("query 0.25 0.02 0.01")
    assert answer["standard_error"] < plain["standard_error"]


def test_what_query_prints_under_a_light_gives_the_answer_back(ask):
    plain = ask("query 0.3 0.2 0.1 --light A")
    lit = ",".join(f"{value:.9f}" for value in plain["lights"]["A"]["srgb"])
    again = ask(f"query 0.3 0.2 0.1 --also A:{lit}")
    assert again["reflectance"] == pytest.approx(plain["reflectance"], abs=1e-5)


def test_contradicting_colours_are_stated(run, ask):
    words = "query 0.2 0.2 0.2 --also A:0.9,0.02,0.02"
    assert ask(words)["contradicts"]
    assert "contradicts" in run(words).stdout


def test_a_texture_of_two_pictures(run, wood, home):
    run("relight", wood, "-o", "tungsten.exr", "--light", "A")
    line = ("texture", wood, "--also", "A:tungsten.exr", "-o", "wood.exr")
    assert "exposure × 1 " in run(*line).stdout
    assert channels(home / "wood.exr")["contradiction"].max() == 0
    given = "--exposure 1 --noise 0.5%,0.0005 --balance light --force"
    text = run(*line, *given.split()).stdout
    assert "0.50% and 0.0005 (as given)" in text


def test_a_picture_that_is_not_balanced(run, wood, home):
    run("relight", wood, "-o", "warm.exr", "--light", "A", "--no-adapt")
    line = ("texture", wood, "--also", "A:warm.exr", "-o", "wood.exr")
    run(*line, "--balance", "none")
    assert channels(home / "wood.exr")["contradiction"].mean() < 0.01


def test_sequences_of_several_lights(run, home):
    picture = planes(np.full((4, 4, 3), 0.5, np.float32))
    for name in ("day.1", "day.2", "tungsten.1", "tungsten.2"):
        write_exr(home / f"{name}.exr", picture)
    run("texture day.*.exr --also A:tungsten.*.exr --processes 1 -o out")
    assert set(os.listdir(home / "out")) == {"day.1.exr", "day.2.exr"}
