"""Outlines of projected meshes."""

from __future__ import annotations

import numpy as np
from matplotlib.path import Path

from uplift.colorimetry.outline import outline
from uplift.colorimetry.sphere import sphere


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
