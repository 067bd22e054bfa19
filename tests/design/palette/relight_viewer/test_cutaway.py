"""Default picture: every material is visible, and layers are where ray marching finds them."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.design.palette.relight_viewer.cutaway import BALL, CORE, OFFSETS, RADIUS, SKIN, _axes, cutaway

SIZE = 24
DEPTHS = np.linspace(1, -1, 4001)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 24])
def test_every_material_is_visible_and_weights_sum_to_at_most_1(count):
    weights = cutaway(count, size=160)
    assert weights.shape == (160, 160, count)
    assert weights.dtype == np.float32
    assert weights.min() == 0
    assert 0.8 < weights.sum(axis=-1).max() <= 1
    assert (weights.max(axis=(0, 1)) > 0.5).all()
    assert not weights[0].any()


def marched(x, y, layers):
    """Layer and depth at which a ray at (x, y) first meets the opened ball, by ray marching; None if it misses."""
    points = np.stack([np.full_like(DEPTHS, x), np.full_like(DEPTHS, y), DEPTHS], axis=1)
    radius = np.linalg.norm(points, axis=1)
    solid = (radius < 1) & ~(points @ _axes() > 0).all(axis=1)
    if not solid.any():
        return None
    depth = (1 - radius[solid.argmax()]) * (layers - 1 + CORE)
    return min(int(depth), layers - 1), depth


@pytest.mark.parametrize("count", [1, 4])
def test_layers_agree_with_ray_marching(count):
    layers, first = max(count - 1, 1), min(1, count - 1)
    weights = cutaway(count, SIZE)[: SIZE * 3 // 4, :, first:]
    compared = 0
    for row in range(3, SIZE * 3 // 4 - 1):
        for column in range(SIZE):
            samples = [sample(row + down, column + across, layers) for across in OFFSETS for down in OFFSETS]
            if None in samples:
                continue
            met = {found[0] for found in samples if found[0] is not None}
            assert set(np.flatnonzero(weights[row, column])) == met, (row, column)
            compared += 1
    assert compared > 150


def sample(row, column, layers):
    """(layer,), or (None,) for a miss; None where ray marching is too coarse."""
    radius = RADIUS * SKIN
    x = ((column + 0.5) * 2 / SIZE - 1 - BALL[0]) / radius
    y = (1 - (row + 0.5) * 2 / SIZE - BALL[1]) / radius
    if abs(np.hypot(x, y) - 1) < 0.01:
        return None
    found = marched(x, y, layers)
    if found is None:
        return (None,)
    layer, depth = found
    return None if abs(depth - round(depth)) < 0.01 and depth > 0.5 else (layer,)


def test_the_skin_is_translucent_and_the_beads_are_not():
    weights = cutaway(3, size=200)
    ball, beads = weights[:150], weights[170:]
    over = (ball[..., 0] > 0) & (ball[..., 1:].sum(axis=-1) > 0)
    assert over.mean() > 0.2
    assert (ball[over][:, 0] < 0.5).mean() > 0.9
    assert (np.count_nonzero(beads, axis=-1) <= 1).all()
