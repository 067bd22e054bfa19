"""Held-out errors: an atlas with predictable spectra, results by hand, and plain
predictors.
"""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import ATLASES
from tests.helpers import raises
from uplift.atlas import Atlas, Entry, read_atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import AtlasError
from uplift.common.progress import Progress
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.fidelity import Answers
from uplift.lab.study import held_out
from uplift.lab.study.held_out import (
    HoldoutSplit,
    halves_both_ways,
    holdout,
    local_linear,
    split_records,
)
from uplift.pipeline.build import build

GRID = observer.grid()


@pytest.fixture(scope="module")
def family():
    """24 spectra of similar colours that share ripples which a smooth spectrum does not
    have.
    """
    ripple = np.cos((GRID - 380) / 400 * 6 * np.pi)
    return Atlas(
        tuple(
            Entry(f"{level:.3f}", GRID, level * (1 + 0.3 * ripple))
            for level in np.linspace(0.3, 0.6, 24)
        )
    )


def test_half_an_atlas_of_similar_spectra_predicts_the_other(family):
    events = []
    splits = holdout(family, 2, events.append, dim=8)
    assert events == [Progress("builds", done, 6) for done in (2, 3, 4, 5, 6)]
    for split in splits:
        means = {method: errors.means() for method, errors in split.errors.items()}
        assert (means["half the atlas"] < 0.5 * means["without an atlas"]).all()
        assert (means["half the atlas"] < 0.5 * means["sigmoid"]).all()
        assert split.errors["sigmoid"].delta_e.shape == (12, len(HELD_OUT_LIGHTS))
    assert not np.array_equal(splits[0].actual, splits[1].actual)


def test_every_row_is_queried_once_per_split():
    for (known, queried), (other, back) in zip(
        *[halves_both_ways(np.arange(3, 10), 4)] * 2, strict=True
    ):
        assert sorted([*known, *queried]) == list(range(3, 10))
        assert (known.tolist(), queried.tolist()) == (back.tolist(), other.tolist())


def test_the_prior_does_not_know_the_atlas(monkeypatch):
    known = []

    def recorded(*args, **options):
        known.append(options["leave_out"])
        return build(*args, **options)

    monkeypatch.setattr(held_out, "build", recorded)
    atlas = read_atlas(ATLASES / "tcs.txt")
    holdout(atlas, 1, dim=4, coefficients=4)
    holdout(atlas, 1, dim=4, coefficients=4, leave_out=("vs",))
    assert known == [("tcs",)] * 4 + [("vs",)] * 4


def test_records_pool_splits_with_standard_errors():
    errors = {"": Answers(np.zeros((2, 81)), np.zeros((2, 7)), np.ones(2))}
    known = HoldoutSplit(
        errors, np.array([1.0, 3.0]), np.array([2.0, 2.0]), np.array([5.0, 5.0])
    )
    unknown = HoldoutSplit(errors, np.array([5.0, 9.0]), None, None)
    (record,) = split_records([known, unknown])
    found = record["standard_error"]
    assert (found["stated"], found["within_error"], found["within_bound"]) == (
        2,
        0.5,
        1,
    )
    assert found["real"] == pytest.approx(2 * (0.5 + 0.68))
    assert (record["rms"], record["FL11"]) == (1, 0)
    assert split_records([unknown])[0]["standard_error"] is None


def test_small_atlas_raises(family):
    with raises(AtlasError, "too-few-entries"):
        holdout(Atlas(family.entries[:7]), 1, dim=4)


@pytest.fixture(scope="module")
def data():
    return uplift.load().data


@pytest.fixture(scope="module")
def known(sensor):
    spectra = resample(read_atlas(ATLASES / "rawtoaces.txt"), sensor.wavelengths).values
    return spectra[in_unit_cube(sensor.rgb(spectra))][::3]


def test_local_linear_reproduces_spectra_that_are_linear_in_rgb(data):
    spectra = (
        0.5 + np.random.default_rng(0).uniform(-2, 2, (45, 3)) @ observer.light("A").xyz
    )
    known = spectra[:40]
    queried = spectra[40:]
    assert_allclose(
        local_linear(data, known, data.sensor.rgb(queried)), queried, atol=1e-3
    )


def test_local_linear_has_the_least_leave_one_out_error_and_the_queried_colours(
    data, known, monkeypatch
):
    """Compared with leaving out one by one."""
    monkeypatch.setattr(held_out, "BANDWIDTHS", (10.0, 40.0))
    monkeypatch.setattr(held_out, "RIDGES", (1e-6, 1e-2))
    known = known[:20]
    colours = data.sensor.rgb(known)

    def predict(known, rgb, smoothing):
        spectra = np.clip(
            held_out.regress(data.sensor, known, rgb, *smoothing), 1e-4, 1 - 1e-4
        )
        return held_out.with_least_change(data, spectra, rgb)

    def slow(smoothing):
        predicted = [
            predict(np.delete(known, row, axis=0), colours[row : row + 1], smoothing)
            for row in range(len(known))
        ]
        differences = [
            delta_e_spectra(observer.light(name), np.concatenate(predicted), known)
            for name in SCENE_LIGHTS
        ]
        return np.mean(differences)

    best = min(itertools.product((10.0, 40.0), (1e-6, 1e-2)), key=slow)
    rgb = data.sensor.rgb(known.mean(axis=0)[None]) * [[0.9, 1.0, 1.1]]
    spectra = local_linear(data, known, rgb)
    assert_allclose(spectra, predict(known, rgb, best), atol=1e-12)
    assert_allclose(data.sensor.rgb(spectra), rgb, atol=1e-6)
