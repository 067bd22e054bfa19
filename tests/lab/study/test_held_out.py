"""Held-out errors: an atlas with predictable spectra, results by hand, and plain
predictors.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import ATLASES
from tests.helpers import raises
from uplift.atlas import Atlas, Entry, read_atlas, resample
from uplift.colorimetry import in_unit_cube, observer
from uplift.common.errors import AtlasError
from uplift.common.progress import Progress
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.fidelity import Answers
from uplift.lab.study import held_out
from uplift.lab.study.held_out import (
    HoldoutSplit,
    halves_both_ways,
    holdout,
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
    splits = holdout(family, 2, events.append, dim=8, trust_atlas=True)
    assert events == [Progress("builds", done, 6) for done in (2, 3, 4, 5, 6)]
    for split in splits:
        means = {method: errors.means() for method, errors in split.errors.items()}
        assert (means["half the atlas"] < 0.6 * means["without an atlas"]).all()
        assert (means["half the atlas"] < 0.6 * means["sigmoid"]).all()
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
    colours = {"map": np.full((2, 7), 3.0)}
    actual = np.array([1.0, 3.0])
    known = HoldoutSplit(
        errors, colours, actual, np.array([2.0, 2.0]), np.array([5.0, 5.0])
    )
    unknown = HoldoutSplit(errors, colours, np.array([5.0, 9.0]), None, None)
    record, mapped = split_records([known, unknown])
    assert (mapped["cube"], mapped["rms"], mapped["HP1"]) == ("map", None, 3)
    found = record["standard_error"]
    assert (found["stated"], found["within_error"], found["within_bound"]) == (
        2,
        0.5,
        1,
    )
    assert found["real"] == pytest.approx(2 * (0.5 + 0.68))
    assert (record["rms"], record["FL11"]) == (1, 0)
    assert split_records([unknown])[0]["standard_error"] is None


def test_methods_that_know_the_library_are_tested_on_the_queried_half(monkeypatch):
    """Their errors belong to the entries within sRGB, in the order of the cubes."""
    atlas = read_atlas(ATLASES / "tcs.txt")

    def marker(data, known, measured, lights):
        return {"mean": measured.mean(axis=1)}

    monkeypatch.setattr(held_out, "rival_errors", marker)
    measured = resample(atlas, GRID).values
    inside = np.flatnonzero(in_unit_cube(observer.sensor().rgb(measured)))
    assert len(inside) < len(measured)
    splits = holdout(atlas, 1, dim=4, coefficients=4)
    for split, (_, other) in zip(splits, halves_both_ways(inside, 1), strict=True):
        assert_allclose(split.colours["mean"], measured[other].mean(axis=1))


def test_small_atlas_raises(family):
    with raises(AtlasError, "too-few-entries"):
        holdout(Atlas(family.entries[:7]), 1, dim=4)
