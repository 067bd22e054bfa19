"""Pictures from files: labels as colours or greys, and float weights; layers of the ball are where rays meet them."""

from __future__ import annotations

import matplotlib.image
import numpy as np
import OpenEXR
import pytest

from uplift.common.errors import OptionError, TextureError, UnknownNameError
from uplift.design.palette import picture
from uplift.design.palette.picture import BALL, CORE, OFFSETS, RADIUS, cut_axes, cutaway, read_weights

NAMES = ("skin", "bone")
LABELS = {"skin": "#ff8000", "bone": "#00ff10"}
SKIN, BONE, BLACK = (255, 128, 0), (0, 255, 16), (0, 0, 0)


def png(path, pixels):
    matplotlib.image.imsave(path, np.array(pixels, dtype=np.uint8))
    return path


def exr(path, **planes):
    planes = {name: np.array(plane, dtype=np.float32) for name, plane in planes.items()}
    OpenEXR.File({"type": OpenEXR.scanlineimage}, planes).write(str(path))
    return path


@pytest.mark.parametrize(
    ("pixels", "labels", "weights"),
    [
        ([SKIN, BONE, BLACK], LABELS, [[1, 0], [0, 1], [0, 0]]),  # black is empty
        ([SKIN, BLACK], {**LABELS, "bone": "#000000"}, [[1, 0], [0, 1]]),  # unless it is a label
        ([(0, 0, 0), (1, 1, 1), (2, 2, 2)], None, [[0, 0], [1, 0], [0, 1]]),  # greys in order by default
        ([(*SKIN, 255), (*SKIN, 51), (*BONE, 0), (9, 9, 9, 0)], LABELS, [[1, 0], [0.2, 0], [0, 0], [0, 0]]),  # alpha
    ],
)
def test_colours_are_labels_and_alpha_is_the_weight(tmp_path, pixels, labels, weights):
    found = read_weights(png(tmp_path / "a.png", [pixels]), NAMES, labels)
    assert found.dtype == np.float32
    assert found[0] == pytest.approx(np.array(weights))


def test_channels_named_after_materials_are_their_weights(tmp_path):
    path = exr(tmp_path / "a.exr", bone=[[0.5, 1.5]], skin=[[0.25, 0]], Z=[[7, 8]])
    assert read_weights(path, NAMES).tolist() == [[[0.25, 0.5], [0, 1.5]]]
    path = exr(tmp_path / "b.exr", bone=[[0.5, 1.5]])
    assert read_weights(path, NAMES).tolist() == [[[0, 0.5], [0, 1.5]]]


@pytest.mark.parametrize(
    ("content", "labels", "error"),
    [
        ([[SKIN]], {"skim": "#ffffff"}, UnknownNameError),
        ([[SKIN]], {"skin": "orange"}, OptionError),
        ([[SKIN]], {"skin": "#ffffff", "bone": "#FFFFFF"}, OptionError),
        ([[SKIN, (1, 2, 3), (9, 9, 9)]], LABELS, TextureError),
        ([[SKIN] * 11], LABELS, TextureError),
        ({"R": [[1.0]], "G": [[1.0]], "B": [[1.0]]}, None, TextureError),
        ({"skin": [[np.nan]]}, None, TextureError),
        ({"skin": [[-0.1]]}, None, TextureError),
        (None, None, TextureError),
    ],
)
def test_unusable_pictures_and_labels_are_refused(tmp_path, monkeypatch, content, labels, error):
    monkeypatch.setattr(picture, "MAX_PIXELS", 10)
    path = tmp_path / ("a.exr" if isinstance(content, dict) else "a.png")
    if isinstance(content, dict):
        exr(path, **content)
    elif content is not None:
        png(path, content)
    with pytest.raises(error) as caught:
        read_weights(path, NAMES, labels)
    assert caught.value.path == (path if error is TextureError else None)


SIZE = 24
DEPTHS = np.linspace(1, -1, 4001)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 24])
def test_every_material_is_visible_and_weights_sum_to_at_most_1(count):
    weights = cutaway(count, size=160)
    assert weights.min() == 0
    assert 0.8 < weights.sum(axis=-1).max() <= 1
    assert (weights.max(axis=(0, 1)) > 0.5).all()
    assert not weights[0].any()


def marched(x, y, layers):
    """Layer and depth at which a ray at (x, y) first meets the opened ball, by ray marching; None if it misses."""
    points = np.stack([np.full_like(DEPTHS, x), np.full_like(DEPTHS, y), DEPTHS], axis=1)
    radius = np.linalg.norm(points, axis=1)
    solid = (radius < 1) & ~(points @ cut_axes() > 0).all(axis=1)
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
    radius = RADIUS * picture.SKIN
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
