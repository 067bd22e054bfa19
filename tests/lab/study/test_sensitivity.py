"""Sensitivity to queries and atlases; Lipschitz constants are never exceeded, and attained."""

from __future__ import annotations

import json

import numpy as np
import pytest

from uplift.atlas import read_atlas
from uplift.colorimetry import observer
from uplift.lab.study.lipschitz import face_cuts, lipschitz_constants
from uplift.lab.study.sensitivity import (
    CONTINUOUS_MODES,
    Change,
    changed_atlases,
    compare,
    perturb,
    rebuild,
    study_sensitivity,
)
from uplift.lattice import CORNERS
from uplift.lookup.interpolate import lattice_spectra

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
    result = study_sensitivity(plain_cube, None, 5)
    record = json.loads(json.dumps(result.record()))
    assert record["changes"] == result.removed == []
    assert record["lipschitz"]["largest_box"] is None
    assert record["lipschitz"]["largest"] >= record["lipschitz"]["median_cell"]


RNG = np.random.default_rng(6)


@pytest.fixture(scope="module")
def steep(small_cube):
    return lipschitz_constants(small_cube.data)


def quotient(first, second, before, after):
    """Change of spectra (n, N), rms over wavelength, per unit of change of colours (n, 3)."""
    return np.sqrt(((after - before) ** 2).mean(axis=1)) / np.linalg.norm(second - first, axis=1)


def test_no_pair_of_colours_exceeds_the_constant(small_cube, steep):
    # As many colours in each cell of the axis, so that some are in the steepest.
    first = small_cube.decode(255 * RNG.random((3000, 3)))
    for size in (1.0, 1e-2, 1e-5):
        second = np.clip(first + size * RNG.normal(size=first.shape), 0, 1)
        quotients = quotient(first, second, small_cube.reflectance(first), small_cube.reflectance(second))
        assert quotients.max() <= steep.largest * (1 + 1e-6)
        assert quotients.max() > 0.1 * steep.largest or size == 1.0


def test_constant_is_attained_in_the_steepest_cell(small_cube, steep):
    data = small_cube.data
    nodes = data.lattice.nodes
    low = np.array(np.unravel_index(steep.cells.argmax(), steep.cells.shape))
    inward = 1 - 2 * CORNERS
    corners = nodes[low + CORNERS]
    sides = nodes[low + 1] - nodes[low]
    directions = RNG.normal(size=(400, 3))
    directions = np.concatenate([np.abs(directions), np.eye(3)])
    best = 0.0
    for corner, sign in zip(corners, inward, strict=True):
        for mirror in ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)):
            step = 1e-4 * sides.min() * directions * mirror
            start = corner + sign * 1e-3 * sides
            before = lattice_spectra(data, start[None], data.sensor.wavelengths)
            after = lattice_spectra(data, start + step, data.sensor.wavelengths)
            best = max(best, quotient(start, start + step, before, after).max())
    assert best == pytest.approx(steep.cells.max(), rel=0.01)


def test_constant_of_a_box_is_attained(small_cube, steep):
    """Near the rays from the entry to all corners of the patches on its box, in random directions."""
    data = small_cube.data
    entry = steep.boxes.argmax()
    low, high = (face[entry] for face in data.entry_boxes.faces)
    middle = data.atlas.rgb[entry]
    corners = np.stack(np.meshgrid(*face_cuts(data, entry), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    nearby = corners + 1e-3 * (high - low) * RNG.normal(size=(len(corners), 200, 3))
    first = (middle + 0.5 * (nearby - middle)).reshape(-1, 3)
    second = first + 1e-5 * (high - low).min() * RNG.normal(size=first.shape)
    quotients = quotient(first, second, small_cube.reflectance(first), small_cube.reflectance(second))
    assert 0.9 * steep.boxes[entry] < quotients.max() <= steep.boxes[entry] * (1 + 1e-4)


def test_constants_per_code_follow_the_transfer_curve(plain_cube):
    """The ratio lies between the slopes of the curve, and equals the last slope in the last cell."""
    data = plain_cube.data
    steep = lipschitz_constants(data)
    slope = np.diff(data.sensor.decoding)
    ratio = steep.codes / steep.cells
    assert ratio.min() >= slope.min() * (1 - 1e-9)
    assert ratio.max() <= slope.max() * (1 + 1e-9)
    assert ratio[-1, -1, -1] == pytest.approx(slope[-1], rel=1e-6)
    assert steep.boxes.size == 0
    assert steep.largest == steep.cells.max()
