"""Sensitivity to queries and atlases."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import uplift
from uplift.atlas import read_atlas
from uplift.colorimetry import delta_e_spectra, observer
from uplift.lab.chart.selection import perturb_method, select_methods
from uplift.lab.study.sensitivity import (
    CONTINUOUS_MODES,
    Change,
    _largest_jump,
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
    for wide, narrow, rounding in zip(
        moves[::3], moves[1::3], moves[2::3], strict=True
    ):
        assert wide["rms_mean"] == pytest.approx(4 * narrow["rms_mean"], rel=0.1)
        assert wide["own_mean"] == pytest.approx(4 * narrow["own_mean"], rel=0.05)
        assert 0 < rounding["rms_most"] < 1e-5
        assert 0 < rounding["light_most"] < 1e-2
        assert wide["rms_mean"] < wide["rms_most"] < wide["largest"]


def test_cubes_of_any_wavelengths_are_studied():
    cube = uplift.build(dim=3, step=10)
    moves, changes = study_sensitivity(cube, None, 0)
    assert len(moves) == 3 * len(CONTINUOUS_MODES)
    assert changes == []


def test_jumps_are_found_and_only_those():
    """Answers that jump by hand, at a red of 0.5, and continuous ones as steep as a
    step of a code allows.
    """
    first = np.full((9, 3), 0.495)
    second = np.full((9, 3), 0.505)
    first[:, 0] += np.linspace(0, 0.004, 9)
    dark = np.full(81, 0.2)
    bright = np.linspace(0.2, 0.5, 81)

    def sudden(rgb):
        return np.where(rgb[:, :1] < 0.5, dark, bright)

    def steep(rgb):
        return dark + np.clip((rgb[:, :1] - 0.498) / 0.004, 0, 1) * (bright - dark)

    expected = delta_e_spectra(LIGHT, dark, bright)
    assert _largest_jump(sudden, LIGHT, first, second) == pytest.approx(float(expected))
    assert _largest_jump(steep, LIGHT, first, second) < 1e-3 * expected


def test_otsu_2018_jumps_and_others_do_not(small_cube):
    mallett, otsu = (
        perturb_method(method, LIGHT, 300)
        for method in select_methods(("otsu2018", "mallett2019"))
    )
    assert otsu[0]["mode"] == "Otsu 2018"
    assert otsu[0]["light_most"] >= otsu[0]["jump"] > 2
    assert (
        max(move["jump"] for move in (*mallett, *perturb(small_cube, LIGHT, 300)))
        < 2e-3
    )
    assert mallett[0]["own_mean"] == pytest.approx(4 * mallett[1]["own_mean"], rel=0.05)


def test_changed_atlases_and_their_effect(repository):
    """Far nodes move a little: the weights of the families of spectra are learnt from
    the whole atlas.
    """
    entries = read_atlas(repository / "atlases" / "tcs.txt").entries
    before = rebuild(entries, {"dim": 8})
    name = entries[0].name
    changes = {
        description: changed
        for description, _, changed in changed_atlases(entries, [name])
    }
    assert list(changes) == [
        *(f"noise, draw {seed}" for seed in range(3)),
        f"{name} wrong",
        f"{name} left out",
    ]
    noisy, wrong, left_out = (
        changes[key] for key in ("noise, draw 0", f"{name} wrong", f"{name} left out")
    )
    noise = np.array(
        [one.values - other.values for one, other in zip(noisy, entries, strict=True)]
    )
    assert noise.std() == pytest.approx(0.002, rel=0.1)
    assert_array_equal(wrong[0].values, entries[0].values[::-1])
    assert wrong[1:] == left_out == list(entries[1:])

    removed = compare(before, rebuild(left_out, {"dim": 8}), LIGHT, "", name)
    nearest = removed.distance.argmin(axis=1)
    _, lab_distance = removed.distance
    assert (removed.delta_e[nearest] > 0).all()
    far = lab_distance > 60
    assert far.sum() > 100
    assert removed.delta_e[far].mean() < 0.3 * removed.delta_e[lab_distance < 20].mean()
    record = compare(before, rebuild(wrong, {"dim": 8}), LIGHT, "", name).record()
    assert 0 < record["moved"] < 0.1
    assert 0 < record["lab_radius"] < 80
    assert compare(before, before, LIGHT, "").record()["rgb_radius"] is None


def test_moved_share_and_radius_by_hand():
    delta_e = np.array([0.1, 0.6, 2, 0.5])
    record = Change(
        "", np.zeros(4), delta_e, np.array([[0.0, 1, 2, 3], [9, 5, 4, 9]])
    ).record()
    assert (record["moved"], record["rgb_radius"], record["lab_radius"]) == (0.5, 2, 5)
    assert (
        Change("", np.zeros(1), np.zeros(1), np.ones((2, 1))).record()["rgb_radius"]
        == 0
    )
