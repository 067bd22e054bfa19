"""``--also``: further photographs, under other lights."""

import json

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


def test_a_colour_under_two_lights(run, home):
    text = run("query #8a2a20 --also A:#9a2a22 --light HP1").stdout
    assert "also under" in text
    answer = json.loads(
        run("query 0.25 0.02 0.01 --also A:0.32,0.021,0.012 --format json").stdout
    )
    cube = uplift.load()
    prepared = prepare(cube, [photograph(cube.data.sensor, "A")])
    rgb = [0.25, 0.02, 0.01]
    others = [0.32, 0.021, 0.012]
    expected = prepared.reflectance(rgb, others)
    assert answer["reflectance"] == pytest.approx(expected.tolist(), abs=1e-9)
    assert answer["also"] == {"A": others}
    assert not answer["contradicts"]
    plain = json.loads(run("query 0.25 0.02 0.01 --format json").stdout)
    assert answer["standard_error"] < plain["standard_error"]


def test_what_query_prints_under_a_light_gives_the_answer_back(run):
    plain = json.loads(run("query 0.3 0.2 0.1 --light A --format json").stdout)
    lit = ",".join(f"{value:.9f}" for value in plain["lights"]["A"]["srgb"])
    again = json.loads(run(f"query 0.3 0.2 0.1 --also A:{lit} --format json").stdout)
    assert again["reflectance"] == pytest.approx(plain["reflectance"], abs=1e-5)


def test_contradicting_colours_are_stated(run):
    answer = json.loads(
        run("query 0.2 0.2 0.2 --also A:0.9,0.02,0.02 --format json").stdout
    )
    plain = json.loads(run("query 0.2 0.2 0.2 --format json").stdout)
    assert answer["contradicts"]
    assert answer["reflectance"] == pytest.approx(plain["reflectance"])
    assert answer["standard_error"] == pytest.approx(plain["standard_error"], rel=0.15)
    text = run("query 0.2 0.2 0.2 --also A:0.9,0.02,0.02").stdout
    assert "contradicts" in text


def test_a_texture_of_two_pictures(run, wood, home):
    run("relight", wood, "-o", "tungsten.exr", "--light", "A")
    text = run("texture", wood, "--also", "A:tungsten.exr", "-o", "wood.exr").stdout
    assert "exposure × 1 " in text
    assert "noise" in text
    planes_of = channels(home / "wood.exr")
    assert planes_of["contradiction"].max() == 0
    given = ("--exposure", 1, "--noise", "0.5%,0.0005", "--balance", "light")
    line = ("texture", wood, "--also", "A:tungsten.exr", "-o", "given.exr")
    text = run(*line, *given).stdout
    assert "as given" in text
    assert "0.50% and 0.0005 (as given)" in text


def test_a_picture_that_is_not_balanced(run, wood, home):
    run("relight", wood, "-o", "warm.exr", "--light", "A", "--no-adapt")
    line = ("texture", wood, "--also", "A:warm.exr", "-o", "wood.exr")
    run(*line, "--balance", "none")
    assert channels(home / "wood.exr")["contradiction"].mean() < 0.01


def test_several_pictures_of_several_lights(run, home):
    rng = np.random.default_rng(3)
    detail = rng.uniform(0.2, 0.6, (32, 32, 3)).astype(np.float32)
    for number in (1, 2):
        for name in ("day", "tungsten", "tubes"):
            write_exr(home / f"{name}.{number}.exr", planes(detail))
    run(
        *("texture", "day.*.exr", "--also", "A:tungsten.*.exr"),
        *("--also", "FL11:tubes.*.exr", "--processes", 1, "-o", "out"),
    )
    assert sorted(path.name for path in (home / "out").iterdir()) == [
        "day.1.exr",
        "day.2.exr",
    ]
