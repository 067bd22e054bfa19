"""Ranks of second lights: those of errors computed one by one, and their laws."""

import numpy as np
import pytest

import uplift
from tests.conftest import ROOT
from tests.helpers import raises, without_evidence
from uplift.colorimetry.illuminants import Lamp
from uplift.colorimetry.observer import light
from uplift.common.errors import OptionError
from uplift.extras.photographs.answers import prepare
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.photograph import photograph
from uplift.extras.scene.second_light import (
    default_candidates,
    error_without,
    rank_second_lights,
)
from uplift.extras.texture.scene_colours import PixelSample

TARGETS = [light(name) for name in ("FL2", "FL11", "HP1")]


@pytest.fixture(scope="module")
def cube():
    return uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")


@pytest.fixture(scope="module")
def colours():
    random = np.random.default_rng(3)
    area = random.exponential(size=30)
    return PixelSample(random.random((30, 3)), area / area.sum())


def test_errors_are_those_of_two_photographs_averaged_over_area_and_lights(
    cube, colours
):
    ranked = rank_second_lights(cube, colours, ["A", "LED-B3"], TARGETS)
    assert [row.mean for row in ranked] == sorted(row.mean for row in ranked)
    for row in ranked:
        further = photograph(cube.data.sensor, row.light)
        photographs = prepare(cube, [further], (0.005, 0.0005))
        for lit in TARGETS:
            standard = light_errors(photographs, lit)(colours.rgb)[:, 0]
            expected = np.average(standard, weights=colours.share)
            assert row.by_light[lit.name] == pytest.approx(expected)
        assert row.mean == pytest.approx(np.mean(list(row.by_light.values())))


def test_a_second_photograph_lowers_errors_and_noise_raises_them(cube, colours):
    without = error_without(cube, colours, TARGETS)
    means = []
    for share in (0.0, 0.005, 0.02):
        [row] = rank_second_lights(cube, colours, ["A"], TARGETS, (share, share / 10))
        means.append(row.mean)
    assert means[0] < means[1] < means[2]
    assert means[1] < without.mean


def test_a_light_that_things_are_targets_is_the_best_for_it(cube, colours):
    candidates = ["FL11", "A", "D50"]
    ranked = rank_second_lights(cube, colours, candidates, [light("FL11")], (0.0, 0.0))
    assert ranked[0].light == "FL11"


def test_lamps_may_be_candidates_and_a_lamp_like_daylight_helps_little(cube, colours):
    known = cube.data.sensor
    nearly = known.power * np.linspace(1, 1.02, 81)
    lamp = Lamp("flash", tuple(known.wavelengths), tuple(nearly))
    ranked = rank_second_lights(cube, colours, [lamp, "A"], TARGETS)
    assert [row.light for row in ranked] == ["A", "flash"]


def test_the_light_of_the_cube_is_no_default(cube):
    assert "D65" not in default_candidates(cube)
    assert "A" in default_candidates(cube)


@pytest.mark.parametrize(
    ("candidates", "targets", "noise"),
    [
        ([], TARGETS, 0.0),
        (["A"], [], 0.0),
        (["D65"], TARGETS, 0.0),
        (["A"], TARGETS, -1.0),
    ],
)
def test_bad_input(cube, colours, candidates, targets, noise):
    with raises(OptionError):
        rank_second_lights(cube, colours, candidates, targets, (noise, 0.0))


def test_errors_need_entries_that_were_left_out(cube, colours):
    with raises(OptionError, "too-few-entries"):
        error_without(without_evidence(cube), colours, TARGETS)
