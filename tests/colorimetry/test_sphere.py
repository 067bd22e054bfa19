"""Directions spread over the sphere."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.path import Path

from uplift.colorimetry.mismatch import COUNTS, mesh_volume, outline, sphere


@pytest.mark.parametrize("divisions", range(4))
def test_directions_are_unit_vectors_of_a_closed_mesh(divisions):
    found = sphere(divisions)
    assert found.directions.shape == (COUNTS[divisions], 3)
    np.testing.assert_allclose(np.linalg.norm(found.directions, axis=1), 1)
    assert len(found.directions) - 3 * len(found.faces) // 2 + len(found.faces) == 2  # Euler
    edges = np.sort(found.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    volume = mesh_volume(found.directions[None], found.faces)[0]
    assert 4 * np.pi / 3 * (1 - 0.6 / 4**divisions) < volume < 4 * np.pi / 3


def test_parents_are_near():
    found = sphere(3)
    children = np.arange(12, len(found.directions))
    assert (found.parents[children] < children).all()
    near = (found.directions[children] * found.directions[found.parents[children]]).sum(axis=1)
    assert near.min() > 0.85


def test_a_sphere_has_a_round_outline():
    found = sphere(3)
    moved = found.directions[:, :2] + np.array([3.0, -2.0])
    radius = np.hypot(*(outline(moved, found.faces) - np.array([3.0, -2.0])).T)
    assert radius.min() > 0.99
    assert radius.max() <= 1 + 1e-12


def test_all_points_lie_within_the_outline():
    found = sphere(2)
    points = found.directions[:, :2] * [2.0, 1.0] + 0.2 * found.directions[:, 2:]
    limits = outline(points, found.faces, angles=360)
    centre = points.mean(axis=0)
    inside = Path(centre + 1.01 * (limits - centre)).contains_points(points)
    assert inside.all()
    assert not Path(centre + 0.95 * (limits - centre)).contains_points(points).all()
