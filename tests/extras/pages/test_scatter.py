"""Placement of labels."""

import numpy as np

from uplift.extras.pages.scatter import place_labels

PANEL = np.array([0.0, 0.0, 300.0, 200.0])


def overlapping(corners, sizes):
    """How many pairs of labels touch."""
    low = np.maximum(corners[:, None], corners)
    high = np.minimum((corners + sizes)[:, None], corners + sizes)
    return int(np.triu((high > low).all(axis=-1), 1).sum())


def test_labels_of_close_points_do_not_overlap():
    anchors = np.random.default_rng(1).normal((290, 100), (3, 12), (9, 2))
    sizes = np.tile([48.0, 9.0], (9, 1))
    corners = place_labels(anchors, sizes, anchors, PANEL)
    assert overlapping(anchors, sizes) > 10
    placed = ~np.isnan(corners).any(axis=1)
    assert placed.sum() >= 5
    corners = corners[placed]
    sizes = sizes[placed]
    assert overlapping(corners, sizes) == 0
    covered = (anchors > corners[:, None]) & (anchors < (corners + sizes)[:, None])
    assert not covered.all(axis=-1).any()
    assert (corners >= PANEL[:2]).all()
    assert (corners + sizes <= PANEL[2:]).all()
