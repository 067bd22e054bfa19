"""Synthetic atlases: reproducible, and as difficult as their names."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.lab.study.stability import SYNTHETIC_ATLASES, crowded, noisy, spiky


def values(atlas):
    return np.array([entry.values for entry in atlas.entries])


@pytest.mark.parametrize("name", SYNTHETIC_ATLASES)
def test_atlases_are_reproducible(name):
    first, second = SYNTHETIC_ATLASES[name](), SYNTHETIC_ATLASES[name]()
    np.testing.assert_array_equal(values(first), values(second))
    assert first.names == second.names


def test_atlases_are_crowded_spiky_and_noisy(sensor):
    lab = rgb_to_lab(sensor, sensor.rgb(values(crowded())))
    distance = np.linalg.norm(lab[:, None] - lab, axis=-1) + 1e3 * np.eye(len(lab))
    assert np.median(distance.min(axis=1)) < 1
    assert (np.abs(np.diff(values(spiky()), axis=1)).max(axis=1) > 0.2).all()
    rough = np.diff(values(noisy()), n=2, axis=1).std()
    assert rough == pytest.approx(0.05 * 6**0.5, rel=0.1)
    assert values(noisy()).min() < 0
    assert values(noisy()).max() > 1
    assert all(entry.wavelengths.shape == observer.grid().shape for entry in noisy().entries)
