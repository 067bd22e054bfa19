"""Placement of labels next to points where they cover as little as possible."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array

DISTANCES = (6.0, 14.0, 24.0, 36.0, 50.0, 66.0)
"""Points between a marker and its label."""
_SIDES = [(x, y) for x in (1.0, -1.0) for y in (0.0, 0.5, -0.5, 1.0, -1.0)]
DIRECTIONS = np.array([*_SIDES, *((x, y) for y in (1.0, -1.0) for x in (0.0, 0.5, -0.5))])
OUTSIDE_COST, OVERLAP_COST, DISTANCE_COST = 50.0, 12.0, 0.02
"""Costs of a position outside the panel, over another label, and per point of distance. A marker below costs 1."""


def place_labels(anchors: Array, sizes: Array, markers: Array, panel: Array) -> Array:
    """Choose positions for labels one after the other, each where its cost is least.

    Parameters
    ----------
    anchors : ndarray, shape (L, 2)
        Positions of the markers to label, in points.
    sizes : ndarray, shape (L, 2)
        Widths and heights of the labels.
    markers : ndarray, shape (M, 2)
        Positions of all markers.
    panel : ndarray, shape (4,)
        x0, y0, x1, y1 of the panel.

    Returns
    -------
    ndarray, shape (L, 2)
        Lower left corners of the labels.
    """
    placed = np.empty((0, 4))
    corners = np.empty_like(anchors)
    for row, (anchor, size) in enumerate(zip(anchors, sizes, strict=True)):
        options = np.concatenate([_corners_around(anchor, size, distance) for distance in DISTANCES])
        boxes = np.concatenate([options, options + size], axis=1)
        cost = DISTANCE_COST * np.repeat(DISTANCES, len(DIRECTIONS))
        cost += OUTSIDE_COST * _outside(boxes, panel)
        cost += OVERLAP_COST * _overlaps(boxes, placed).sum(axis=1) + _contains(boxes, markers).sum(axis=1)
        best = int(cost.argmin())
        corners[row] = options[best]
        placed = np.concatenate([placed, boxes[best : best + 1]])
    return corners


def _corners_around(anchor: Array, size: Array, distance: float) -> Array:
    """Corners (16, 2) of a label at a distance from its anchor, in all directions."""
    return np.asarray(anchor + distance * DIRECTIONS + size * (np.sign(DIRECTIONS) - 1) / 2)


def _overlaps(boxes: Array, others: Array) -> Array:
    low = np.maximum(boxes[:, None, :2], others[None, :, :2])
    high = np.minimum(boxes[:, None, 2:], others[None, :, 2:])
    return np.asarray((high > low).all(axis=-1))


def _contains(boxes: Array, points: Array) -> Array:
    near = (points > boxes[:, None, :2] - 2) & (points < boxes[:, None, 2:] + 2)
    return np.asarray(near.all(axis=-1))


def _outside(boxes: Array, panel: Array) -> Array:
    return np.asarray(((boxes[:, :2] < panel[:2]) | (boxes[:, 2:] > panel[2:])).any(axis=1))
