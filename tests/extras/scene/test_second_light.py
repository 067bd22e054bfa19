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
from uplift.extras.scene.second_light import error_without, rank_second_lights
from uplift.extras.texture.scene_colours import PixelSample

TARGETS = [light(name) for name in ("FL2", "FL11")]


@pytest.fixture(scope="module")
def cube():
    return uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")


@pytest.fixture(scope="module")
def colours():
    random = np.random.default_rng(3)
    area = random.exponential(size=8)
    return PixelSample(random.random((8, 3)), area / area.sum())


def test_errors_are_those_of_two_photographs_averaged_over_area_and_lights(
    cube, colours
):
    """The light of the target is the best for it, and a lamp like daylight helps
    little.
    """
    known = cube.data.sensor
    nearly = known.power * np.linspace(1, 1.02, 81)
    lamp = Lamp("flash", tuple(known.wavelengths), tuple(nearly))
    ranked = rank_second_lights(cube, colours, [lamp, "A", "FL11"], TARGETS)
    assert [row.light for row in ranked] == ["FL11", "A", "flash"]
    for row, candidate in zip(ranked, ("FL11", "A", lamp), strict=True):
        photographs = prepare(cube, [photograph(known, candidate)], (0.005, 0.0005))
        for lit in TARGETS:
            standard = light_errors(photographs, lit)(colours.rgb)[:, 0]
            expected = np.average(standard, weights=colours.share)
            assert row.by_light[lit.name] == pytest.approx(expected)
        assert row.mean == pytest.approx(np.mean(list(row.by_light.values())))
    assert ranked[0].mean < ranked[1].mean < ranked[2].mean


def test_a_second_photograph_lowers_errors_and_noise_raises_them(cube, colours):
    means = []
    for share in (0.0, 0.005, 0.02):
        [row] = rank_second_lights(cube, colours, ["A"], TARGETS, (share, share / 10))
        means.append(row.mean)
    assert means[0] < means[1] < means[2]
    assert means[1] < error_without(cube, colours, TARGETS).mean


@pytest.mark.parametrize(("candidates", "targets"), [([], TARGETS), (["A"], [])])
def test_bad_input(cube, colours, candidates, targets):
    with raises(OptionError):
        rank_second_lights(cube, colours, candidates, targets)


def test_errors_need_entries_that_were_left_out(cube, colours):
    with raises(OptionError, "too-few-entries"):
        error_without(without_evidence(cube), colours, TARGETS)
