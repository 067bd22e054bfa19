"""The matrices from raw values to XYZ, on raw values whose matrix is known."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.cameras import lab_matrix, realisable_share, xyz_matrix
from uplift.colorimetry import observer

WHITE = np.array([0.95, 1.0, 1.09])


@pytest.fixture
def known():
    """A matrix that takes (1, 1, 1) to the white."""
    matrix = np.array([[0.6, 0.3, 0.1], [0.3, 0.6, 0.1], [0.05, 0.1, 0.85]])
    return matrix * (WHITE / matrix.sum(axis=1))[:, None]


def test_known_matrices_are_found(known):
    raw = np.random.default_rng(3).random((12, 3))
    np.testing.assert_allclose(xyz_matrix(raw, raw @ known.T), known, rtol=1e-10)
    np.testing.assert_allclose(lab_matrix(raw, raw @ known.T, WHITE), known, rtol=1e-6)


def test_the_matrix_by_lab_keeps_white(known):
    rng = np.random.default_rng(4)
    raw = rng.random((12, 3))
    noisy = raw @ known.T + 0.01 * rng.standard_normal((12, 3))
    np.testing.assert_allclose(lab_matrix(raw, noisy, WHITE).sum(axis=1), WHITE, rtol=1e-12)


def test_overlapping_channels_leave_few_raw_values():
    shares = [realisable_share(observer.sensor("camera", "D65", name), 12) for name in observer.camera_names()]
    assert 0 < shares[1] < shares[0] < 1
