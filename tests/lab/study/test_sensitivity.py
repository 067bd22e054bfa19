"""Sensitivity to queries and atlases: results by hand, and the locality of changes."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.helpers import raises
from uplift.atlas import read_atlas
from uplift.colorimetry import observer
from uplift.common.errors import OptionError
from uplift.lab.study import sensitivity
from uplift.lab.study.sensitivity import (
    CONTINUOUS_MODES,
    Change,
    add_noise,
    build_baseline,
    perturb,
    remove_entry,
    reverse_entry,
)

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


def test_distance_from_a_reversed_entry_is_to_its_old_or_new_colour(base):
    name = base.data.atlas.names[0]
    wrong, without = reverse_entry(base, name), remove_entry(base, name)
    assert (wrong.rgb_distance <= without.rgb_distance + 1e-12).all()
    assert wrong.delta_e.max() > 0


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
