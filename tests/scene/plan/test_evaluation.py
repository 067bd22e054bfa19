"""Errors of answers, against a slow oracle; candidates decided upon."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.scene.plan.decision import Trial, decide
from uplift.scene.plan.evaluation import WORST_DELTA_E, ErrorSummary, EvaluationSet, Group, GroupError
from uplift.scene.plan.previews import make_previews

LIGHTS = ("D65", "FL11")


@pytest.fixture(scope="module")
def question():
    rng = np.random.default_rng(0)
    weights = rng.random(40)
    groups = (
        Group("textures", rng.random((40, 3)), rng.random((40, 81)), weights / weights.sum()),
        Group("materials", rng.random((7, 3)), rng.random((7, 81)), np.full(7, 1 / 7)),
    )
    return EvaluationSet(groups, tuple(observer.light(name) for name in LIGHTS), 0.8)


def counted(values, weights, share):
    """The least value that so large a share of the weights stays within."""
    total = 0.0
    for value, weight in sorted(zip(values, weights, strict=True)):
        total += weight
        if total >= share - 1e-12:
            return value
    raise AssertionError


def test_errors_are_those_of_a_slow_oracle(question):
    answered = np.clip(question.wanted + np.random.default_rng(1).normal(0, 0.02, (47, 81)), 0, 1)
    error = question.error(answered)
    rows = {"textures": slice(0, 40), "materials": slice(40, 47)}
    assert len(error.parts) == 4
    for part in error.parts:
        group = next(each for each in question.groups if each.name == part.group)
        apart = delta_e_spectra(observer.light(part.light), group.wanted, answered[rows[part.group]])
        assert part.quantile == pytest.approx(counted(apart, group.weights, 0.8), rel=1e-9)
        assert part.mean == pytest.approx(np.average(apart, weights=group.weights), rel=1e-9)
        assert part.largest == pytest.approx(apart.max(), rel=1e-9)
    assert error.quantile == max(part.quantile for part in error.parts)


def test_what_is_wanted_has_no_error_and_what_is_no_number_the_largest(question):
    assert question.error(question.wanted).quantile == pytest.approx(0, abs=1e-9)
    broken = question.wanted.copy()
    broken[3] = np.nan
    error = question.error(broken)
    assert {part.largest for part in error.parts if part.group == "textures"} == {WORST_DELTA_E}


def test_fewer_colours_stand_for_the_others(question):
    thin = question.thinned(10)
    textures, materials = thin.groups
    assert len(textures.rgb) <= 10
    assert len(materials.rgb) == 7
    assert textures.weights.sum() == pytest.approx(1)
    kept = [tuple(colour) for colour in question.groups[0].rgb]
    assert all(tuple(colour) in kept for colour in textures.rgb)


def test_sights_are_the_colours_at_their_shares(question):
    xyz = [(0.9 * question.wanted) @ light.xyz.T for light in question.lights]
    found = make_previews(question, xyz, observer.DEFAULT_OBSERVER)
    assert [(sight.light, sight.share) for sight in found] == [
        (light, share) for light in LIGHTS for share in (0.5, 0.8, 1.0)
    ]
    error = question.seen(xyz)
    for sight in found:
        part = next(each for each in error.parts if (each.group, each.light) == ("textures", sight.light))
        wanted = {0.8: part.quantile, 1.0: part.largest}.get(sight.share, sight.delta_e)
        assert sight.delta_e == pytest.approx(wanted)
        assert sight.wanted != sight.planned


def trial(name, error):
    return Trial(name, 1.0, "", "", {}, ErrorSummary((GroupError("textures", "D65", 0.0, error, error),)))


def test_the_first_that_will_do_is_taken_and_no_more_are_measured():
    made = []

    def trials():
        for number, error in enumerate((3.0, 0.9, 0.1)):
            made.append(number)
            yield trial(str(number), error)

    found = decide("a", "A", "things", 1.0, trials())
    assert (found.trial.name, found.kept, made) == ("1", True, [0, 1])


def test_where_none_will_do_the_nearest_is_taken():
    found = decide("a", "A", "things", 1.0, [trial("a", 5), trial("b", 2), trial("c", 3)])
    assert (found.trial.name, found.kept) == ("b", False)
