"""Half an atlas for the other half, against what is known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.atlas import Atlas, Entry
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.lab.study.held_out import (
    HoldoutSplit,
    SpectrumErrors,
    holdout,
    pooled_calibration,
    spectrum_errors,
)

GRID = observer.grid()


@pytest.fixture(scope="module")
def family():
    """Two dozen spectra of one family, ripples that a smooth spectrum does not have, and colours close together."""
    levels = np.linspace(0.3, 0.6, 24)
    ripple = np.cos((GRID - 380) / 400 * 6 * np.pi)
    return Atlas(tuple(Entry(f"{level:.3f}", GRID, level * (1 + 0.3 * ripple)) for level in levels))


@pytest.fixture(scope="module")
def splits(family):
    heard = []
    found = holdout(family, 2, lambda done, total: heard.append((done, total)), dim=8)
    assert heard == [(2, 4), (3, 4), (4, 4)]
    return found


def test_an_atlas_of_one_family_tells_its_other_half(splits):
    for split in splits:
        means = {method: errors.means() for method, errors in split.errors.items()}
        assert (means["half the atlas"] < 0.5 * means["without an atlas"]).all()
        assert (means["half the atlas"] < 0.5 * means["sigmoid"]).all()


def test_every_split_asks_what_it_has_not_kept(splits):
    assert [len(split.real) for split in splits] == [12, 12]
    assert not np.array_equal(splits[0].real, splits[1].real)
    assert splits[0].errors["sigmoid"].delta_e.shape == (12, len(HELD_OUT_LIGHTS))


def test_errors_are_what_they_are_called():
    rng = np.random.default_rng(0)
    answered, measured = rng.random((3, 81)), rng.random((3, 81))
    errors = spectrum_errors(answered, measured, ("A", "FL11"))
    for row in range(3):
        assert errors.rms[row] == pytest.approx(np.sqrt(np.mean((answered[row] - measured[row]) ** 2)))
        for column, name in enumerate(("A", "FL11")):
            apart = delta_e_spectra(observer.light(name), answered[row], measured[row])
            assert errors.delta_e[row, column] == pytest.approx(apart)
    assert errors.means() == pytest.approx([errors.rms.mean(), *errors.delta_e.mean(axis=0)])


def test_stated_errors_by_hand():
    nothing = SpectrumErrors(np.zeros(2), np.zeros((2, 1)))
    found = pooled_calibration(
        [
            HoldoutSplit({"": nothing}, np.array([1.0, 3.0]), np.array([2.0, 2.0])),
            HoldoutSplit({"": nothing}, np.array([5.0, 9.0]), None),
        ]
    )
    assert (found.count, found.predicted, found.within_one, found.within_two) == (2, 2, 0.5, 1)
    assert found.actual == pytest.approx(5**0.5)
    assert pooled_calibration([HoldoutSplit({"": nothing}, np.zeros(2), None)]) is None
