"""Outline of a body in a plane."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Indices

ANGLES = 120
MIN_ROUNDNESS = 1e-12
"""Smallest ratio of the variances along the axes of a shape that is made round."""


def outline(points: Array, faces: Indices, angles: int = ANGLES) -> Array:
    """Compute the outline of a triangle mesh that is projected to a plane.

    Shapes: ``points`` (D, 2), ``faces`` (F, 3) → (angles, 2).
    """
    centre = points.mean(axis=0)
    values, axes = np.linalg.eigh(np.cov(points.T))
    lengths = np.sqrt(np.maximum(values, MIN_ROUNDNESS * values.max() + np.finfo(float).tiny))
    round_points = (points - centre) @ axes / lengths
    turns = np.arange(angles) * (2 * np.pi / angles)
    along, across = (np.stack([np.cos(turns + shift), np.sin(turns + shift)]) for shift in (0.0, np.pi / 2))
    edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    first, second = (round_points[edges[:, end]] for end in (0, 1))
    side_1, side_2 = first @ across, second @ across
    crosses = (side_1 <= 0) != (side_2 <= 0)
    share = np.divide(side_1, side_1 - side_2, out=np.zeros_like(side_1), where=crosses)
    radius = np.where(crosses, first @ along + share * ((second - first) @ along), 0).max(axis=0)
    return np.asarray(centre + (radius[:, None] * along.T * lengths) @ axes.T)
