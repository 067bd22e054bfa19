"""Placement of labels next to points where they cover nothing; labels without such a place are left out."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Mask

DISTANCES = (6.0, 9.0, 14.0, 20.0, 28.0, 38.0)
"""Points between a marker and its label."""
CLEARANCE = (4.5, 2.5)
"""Points that labels keep from markers, sideways and upwards."""
_SIDES = [(x, y) for x in (1.0, -1.0) for y in (0.0, 0.5, -0.5, 1.0, -1.0)]
DIRECTIONS = np.array([*_SIDES, *((x, y) for y in (1.0, -1.0) for x in (0.0, 0.5, -0.5))])


def place_labels(anchors: Array, sizes: Array, markers: Array, panel: Array) -> Array:
    """Choose positions for labels one after the other, each the nearest one that covers nothing.

    Parameters
    ----------
    anchors : ndarray, shape (L, 2)
        Positions of the markers to label, in points, most important first.
    sizes : ndarray, shape (L, 2)
        Widths and heights of the labels.
    markers : ndarray, shape (M, 2)
        Positions that labels must not cover.
    panel : ndarray, shape (4,)
        x0, y0, x1, y1 of the panel.

    Returns
    -------
    ndarray, shape (L, 2)
        Lower left corners of the labels; NaN where a label has no room.
    """
    placed = np.empty((0, 4))
    corners = np.full_like(anchors, np.nan)
    for row, (anchor, size) in enumerate(zip(anchors, sizes, strict=True)):
        options = np.concatenate([_corners_around(anchor, size, distance) for distance in DISTANCES])
        boxes = np.concatenate([options, options + size], axis=1)
        over_label, over_marker = (each.any(axis=1) for each in (_overlaps(boxes, placed), _contains(boxes, markers)))
        taken = np.asarray(_outside(boxes, panel) | over_label | over_marker)
        if not taken.all():
            first = int(taken.argmin())
            corners[row] = options[first]
            placed = np.concatenate([placed, boxes[first : first + 1]])
    return corners


def _corners_around(anchor: Array, size: Array, distance: float) -> Array:
    """Corners (16, 2) of a label at a distance from its anchor, in all directions."""
    return np.asarray(anchor + distance * DIRECTIONS + size * (np.sign(DIRECTIONS) - 1) / 2)


def _overlaps(boxes: Array, others: Array) -> Mask:
    low = np.maximum(boxes[:, None, :2], others[None, :, :2])
    high = np.minimum(boxes[:, None, 2:], others[None, :, 2:])
    return np.asarray((high > low).all(axis=-1))


def _contains(boxes: Array, points: Array) -> Mask:
    near = (points > boxes[:, None, :2] - CLEARANCE) & (points < boxes[:, None, 2:] + CLEARANCE)
    return np.asarray(near.all(axis=-1))


def _outside(boxes: Array, panel: Array) -> Mask:
    return np.asarray(((boxes[:, :2] < panel[:2]) | (boxes[:, 2:] > panel[2:])).any(axis=1))
