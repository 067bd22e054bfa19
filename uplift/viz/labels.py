"""Labels beside points, placed one after the other where they cover least of what is there."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array

AWAY = (6.0, 14.0, 24.0, 36.0, 50.0, 66.0)
"""Points between a point and its label; nearer places are tried first."""
_SIDES = [(x, y) for x in (1.0, -1.0) for y in (0.0, 0.5, -0.5, 1.0, -1.0)]
DIRECTIONS = np.array([*_SIDES, *((x, y) for y in (1.0, -1.0) for x in (0.0, 0.5, -0.5))])
OUTSIDE, COVERED, FAR = 50.0, 12.0, 0.02
"""What a place costs: off the panel, over another label, and a point away. A marker under it costs 1."""


def place(anchors: Array, sizes: Array, markers: Array, panel: Array) -> Array:
    """Lower left corners (L, 2) of labels of ``sizes`` (L, 2) for ``anchors`` (L, 2), among ``markers`` (M, 2), in
    ``panel`` (x0, y0, x1, y1); all in points."""
    taken = np.empty((0, 4))
    corners = np.empty_like(anchors)
    for row, (anchor, size) in enumerate(zip(anchors, sizes, strict=True)):
        options = np.concatenate([_around(anchor, size, away) for away in AWAY])
        boxes = np.concatenate([options, options + size], axis=1)
        cost = FAR * np.repeat(AWAY, len(DIRECTIONS))
        cost += OUTSIDE * _beyond(boxes, panel)
        cost += COVERED * _overlaps(boxes, taken).sum(axis=1) + _holds(boxes, markers).sum(axis=1)
        best = int(cost.argmin())
        corners[row] = options[best]
        taken = np.concatenate([taken, boxes[best : best + 1]])
    return corners


def _around(anchor: Array, size: Array, away: float) -> Array:
    """Corners (16, 2) of a label ``away`` from its anchor in every direction."""
    return np.asarray(anchor + away * DIRECTIONS + size * (np.sign(DIRECTIONS) - 1) / 2)


def _overlaps(boxes: Array, others: Array) -> Array:
    low = np.maximum(boxes[:, None, :2], others[None, :, :2])
    high = np.minimum(boxes[:, None, 2:], others[None, :, 2:])
    return np.asarray((high > low).all(axis=-1))


def _holds(boxes: Array, points: Array) -> Array:
    near = (points > boxes[:, None, :2] - 2) & (points < boxes[:, None, 2:] + 2)
    return np.asarray(near.all(axis=-1))


def _beyond(boxes: Array, panel: Array) -> Array:
    return np.asarray(((boxes[:, :2] < panel[:2]) | (boxes[:, 2:] > panel[2:])).any(axis=1))
