"""Sensitivity to queries and atlases."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.atlas import read_atlas
from uplift.colorimetry import observer
from uplift.lab.study.sensitivity import (
    CONTINUOUS_MODES,
    Change,
    changed_atlases,
    compare,
    perturb,
    rebuild,
    study_sensitivity,
)

LIGHT = observer.light("FL11")


def test_answers_change_in_proportion_to_the_query(small_cube):
    moves = perturb(small_cube, LIGHT, 200)
    assert [move["mode"] for move in moves[::3]] == list(CONTINUOUS_MODES)
    for wide, narrow, rounding in zip(moves[::3], moves[1::3], moves[2::3], strict=True):
        assert wide["rms_mean"] == pytest.approx(4 * narrow["rms_mean"], rel=0.1)
        assert wide["own_mean"] == pytest.approx(4 * narrow["own_mean"], rel=0.05)
        assert 0 < rounding["rms_most"] < 1e-5
        assert 0 < rounding["light_most"] < 1e-2
        assert wide["rms_mean"] < wide["rms_most"] < wide["largest"]


def test_changed_atlases_and_their_effect(repository):
    """Far nodes move a little: the weights of the families of spectra are learnt from the whole atlas."""
    entries = read_atlas(repository / "atlases" / "tcs.txt").entries
    before, name = rebuild(entries, {"dim": 8}), entries[0].name
    changes = {description: changed for description, _, changed in changed_atlases(entries, [name])}
    assert list(changes) == [*(f"noise, draw {seed}" for seed in range(3)), f"{name} wrong", f"{name} left out"]
    noisy, wrong, left_out = (changes[key] for key in ("noise, draw 0", f"{name} wrong", f"{name} left out"))
    noise = np.array([one.values - other.values for one, other in zip(noisy, entries, strict=True)])
    assert noise.std() == pytest.approx(0.002, rel=0.1)
    np.testing.assert_array_equal(wrong[0].values, entries[0].values[::-1])
    assert wrong[1:] == left_out == list(entries[1:])

    removed = compare(before, rebuild(left_out, {"dim": 8}), LIGHT, "", name)
    nearest, (_, lab_distance) = removed.distance.argmin(axis=1), removed.distance
    assert (removed.delta_e[nearest] > 0).all()
    far = lab_distance > 60
    assert far.sum() > 100
    assert removed.delta_e[far].mean() < 0.15 * removed.delta_e[lab_distance < 20].mean()
    record = removed.record()
    assert 0 < record["moved"] < 0.02
    assert 0 < record["lab_radius"] < 80
    assert compare(before, before, LIGHT, "").record()["rgb_radius"] is None


def test_moved_share_and_radius_by_hand():
    delta_e = np.array([0.1, 0.6, 2, 0.5])
    record = Change("", np.zeros(4), delta_e, np.array([[0.0, 1, 2, 3], [9, 5, 4, 9]])).record()
    assert (record["moved"], record["rgb_radius"], record["lab_radius"]) == (0.5, 2, 5)
    assert Change("", np.zeros(1), np.zeros(1), np.ones((2, 1))).record()["rgb_radius"] == 0


def test_cube_without_an_atlas_has_no_changes(plain_cube):
    moves, changes = study_sensitivity(plain_cube, None, 5)
    assert len(moves) == 3 * len(CONTINUOUS_MODES)
    assert changes == []
