"""Held-out errors: an atlas with predictable spectra, and results computed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import ATLASES
from tests.helpers import raises
from uplift.atlas import Atlas, Entry, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.errors import AtlasError
from uplift.common.progress import Progress
from uplift.lab.study import held_out as module
from uplift.lab.study.held_out import (
    HoldoutSplit,
    SpectrumErrors,
    holdout,
    pooled_calibration,
    spectrum_errors,
)
from uplift.pipeline.build import build

GRID = observer.grid()


@pytest.fixture(scope="module")
def family():
    """24 spectra of similar colours that share ripples which a smooth spectrum does not have."""
    levels = np.linspace(0.3, 0.6, 24)
    ripple = np.cos((GRID - 380) / 400 * 6 * np.pi)
    return Atlas(tuple(Entry(f"{level:.3f}", GRID, level * (1 + 0.3 * ripple)) for level in levels))


@pytest.fixture(scope="module")
def splits(family):
    events = []
    results = holdout(family, 2, events.append, dim=8)
    assert events == [Progress("builds", done, 4) for done in (2, 3, 4)]
    return results


def test_half_an_atlas_of_similar_spectra_predicts_the_other(splits):
    for split in splits:
        means = {method: errors.means() for method, errors in split.errors.items()}
        assert (means["half the atlas"] < 0.5 * means["without an atlas"]).all()
        assert (means["half the atlas"] < 0.5 * means["sigmoid"]).all()


def test_every_split_predicts_another_half(splits):
    assert [len(split.actual) for split in splits] == [12, 12]
    assert not np.array_equal(splits[0].actual, splits[1].actual)
    assert splits[0].errors["sigmoid"].delta_e.shape == (12, len(HELD_OUT_LIGHTS))


def test_the_prior_does_not_know_the_atlas(monkeypatch):
    known = []

    def recorded(*args, **options):
        known.append(options["leave_out"])
        return build(*args, **options)

    monkeypatch.setattr(module, "build", recorded)
    atlas = read_atlas(ATLASES / "tcs.txt")
    holdout(atlas, 1, dim=4, coefficients=4)
    assert known == [("tcs",)] * 3
    holdout(atlas, 1, dim=4, coefficients=4, leave_out=("vs",))
    assert known[3:] == [("vs",)] * 3


def test_spectrum_errors_equal_their_definitions():
    rng = np.random.default_rng(0)
    predicted, measured = rng.random((3, 81)), rng.random((3, 81))
    errors = spectrum_errors(predicted, measured, ("A", "FL11"))
    for row in range(3):
        assert errors.rms[row] == pytest.approx(np.sqrt(np.mean((predicted[row] - measured[row]) ** 2)))
        for column, name in enumerate(("A", "FL11")):
            expected = delta_e_spectra(observer.light(name), predicted[row], measured[row])
            assert errors.delta_e[row, column] == pytest.approx(expected)
    assert errors.means() == pytest.approx([errors.rms.mean(), *errors.delta_e.mean(axis=0)])


def test_calibration_pools_splits_with_standard_errors():
    nothing = SpectrumErrors(np.zeros(2), np.zeros((2, 1)))
    result = pooled_calibration(
        [
            HoldoutSplit({"": nothing}, np.array([1.0, 3.0]), np.array([2.0, 2.0]), np.array([5.0, 5.0])),
            HoldoutSplit({"": nothing}, np.array([5.0, 9.0]), None, None),
        ]
    )
    assert (result.count, result.predicted, result.within_error, result.within_bound) == (2, 2, 0.5, 1)
    assert result.actual == pytest.approx(2 * (0.5 + 0.68))
    assert pooled_calibration([HoldoutSplit({"": nothing}, np.zeros(2), None, None)]) is None


def test_small_atlas_raises(family):
    with raises(AtlasError, "too-few-entries"):
        holdout(Atlas(family.entries[:7]), 1, dim=4)
