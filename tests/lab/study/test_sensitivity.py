"""Sensitivity to queries and atlases; Lipschitz constants are never exceeded, and attained."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.helpers import raises
from uplift.atlas import read_atlas
from uplift.colorimetry import observer
from uplift.common.errors import OptionError
from uplift.lab.study import sensitivity
from uplift.lab.study.lipschitz import _cuts, lipschitz_constants
from uplift.lab.study.sensitivity import (
    CONTINUOUS_MODES,
    Change,
    add_noise,
    build_baseline,
    perturb,
    remove_entry,
)
from uplift.lattice import CORNERS
from uplift.lookup.interpolate import lattice_spectra

LIGHT = observer.light("FL11")


def test_answers_change_in_proportion_to_the_query(small_cube):
    result = perturb(small_cube, LIGHT, 200)
    assert [move.mode for move in result[::3]] == list(CONTINUOUS_MODES)
    for wide, narrow, rounding in zip(result[::3], result[1::3], result[2::3], strict=True):
        assert wide.rms_mean == pytest.approx(4 * narrow.rms_mean, rel=0.1)
        assert wide.own_mean == pytest.approx(4 * narrow.own_mean, rel=0.05)
        assert 0 < rounding.rms_most < 1e-5
        assert 0 < rounding.light_most < 1e-2
        assert wide.rms_mean < wide.rms_most < wide.largest


@pytest.fixture(scope="module")
def base(repository):
    return build_baseline(read_atlas(repository / "atlases" / "tcs.txt"), LIGHT, dim=8)


def test_removing_an_entry_changes_mostly_nearby_points(base):
    """Far points move a little: the weights of the families of spectra are learnt from the whole atlas."""
    name = base.data.atlas.names[0]
    result = remove_entry(base, name)
    assert result.delta_e[result.lab_distance.argmin()] > 0
    far = result.lab_distance > 60
    assert far.sum() > 100
    assert result.delta_e[far].mean() < 0.15 * result.delta_e[result.lab_distance < 20].mean()
    assert 0 < result.moved < 0.02
    assert 0 < result.radius(result.lab_distance) < 80


def test_noise_on_all_entries_has_no_distance(base):
    result = add_noise(base, 0)
    assert result.rms.shape == (512,)
    assert result.rgb_distance.size == 0
    assert np.isnan(result.radius(result.rgb_distance))
    assert result.delta_e.mean() < 0.1


def test_moved_share_and_radius_by_hand():
    change = Change("", np.zeros(4), np.array([0.1, 0.6, 2, 0.5]), np.array([0.0, 1, 2, 3]), np.zeros(4))
    assert change.moved == 0.5
    assert change.radius(change.rgb_distance) == 2
    assert Change("", np.zeros(1), np.zeros(1), np.ones(1), np.ones(1)).radius(np.ones(1)) == 0


def test_cube_without_an_atlas_has_no_changes(plain_cube):
    result = sensitivity.study_sensitivity(plain_cube, None, 5)
    assert (result.noise, result.reversed, result.removed) == ([], [], [])
    record = json.loads(json.dumps(result.record()))
    assert record["changes"] == []
    assert record["lipschitz"]["largest_box"] is None
    assert record["lipschitz"]["largest"] >= record["lipschitz"]["median_cell"]
    with raises(OptionError, "entries-out-of-range"):
        sensitivity.study_sensitivity(plain_cube, None, -1)


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
    cuts = [_cuts(data.lattice.nodes, low[axis], high[axis]) for axis in range(3)]
    corners = np.stack(np.meshgrid(*cuts, indexing="ij"), axis=-1).reshape(-1, 1, 3)
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
