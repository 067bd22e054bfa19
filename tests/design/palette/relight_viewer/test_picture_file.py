"""Pictures from files: labels as colours or greys, and float weights."""

from __future__ import annotations

import matplotlib.image
import numpy as np
import OpenEXR
import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError, TextureError, UnknownNameError
from uplift.design.palette.relight_viewer.picture_file import read_weights

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


def test_colours_are_labels_and_black_is_empty(tmp_path):
    path = png(tmp_path / "a.png", [[SKIN, BONE, BLACK], [BONE, BONE, SKIN]])
    found = read_weights(path, NAMES, LABELS)
    assert found.dtype == np.float32
    assert found.tolist() == [[[1, 0], [0, 1], [0, 0]], [[0, 1], [0, 1], [1, 0]]]


def test_black_can_be_a_label(tmp_path):
    path = png(tmp_path / "a.png", [[SKIN, BLACK]])
    assert read_weights(path, NAMES, {**LABELS, "bone": "#000000"}).tolist() == [[[1, 0], [0, 1]]]


def test_default_labels_are_greys_in_order(tmp_path):
    path = png(tmp_path / "a.png", [[(0, 0, 0), (1, 1, 1), (2, 2, 2)]])
    assert read_weights(path, NAMES).tolist() == [[[0, 0], [1, 0], [0, 1]]]


def test_alpha_is_the_weight(tmp_path):
    path = png(tmp_path / "a.png", [[(*SKIN, 255), (*SKIN, 51), (*BONE, 0), (9, 9, 9, 0)]])
    assert read_weights(path, NAMES, LABELS)[0] == pytest.approx(np.array([[1, 0], [0.2, 0], [0, 0], [0, 0]]))


def test_channels_named_after_materials_are_their_weights(tmp_path):
    path = exr(tmp_path / "a.exr", bone=[[0.5, 1.5]], skin=[[0.25, 0]], Z=[[7, 8]])
    assert read_weights(path, NAMES).tolist() == [[[0.25, 0.5], [0, 1.5]]]
    path = exr(tmp_path / "b.exr", bone=[[0.5, 1.5]])
    assert read_weights(path, NAMES).tolist() == [[[0, 0.5], [0, 1.5]]]


@pytest.mark.parametrize(
    ("labels", "error", "code"),
    [
        ({"skim": "#ffffff"}, UnknownNameError, "unknown-material"),
        ({"skin": "orange"}, OptionError, "invalid-colour"),
        ({"skin": "#ffffff", "bone": "#FFFFFF"}, OptionError, "duplicate-label"),
    ],
)
def test_invalid_labels_are_refused(tmp_path, labels, error, code):
    with raises(error, code):
        read_weights(png(tmp_path / "a.png", [[SKIN]]), NAMES, labels)


def test_unknown_colours_are_listed(tmp_path):
    path = png(tmp_path / "a.png", [[SKIN, (1, 2, 3), (1, 2, 3), (9, 9, 9)]])
    with raises(TextureError, "unknown-label") as caught:
        read_weights(path, NAMES, LABELS)
    assert "got 3 pixels of #010203, #090909" in caught.value.problem
    assert caught.value.path == path


def test_other_images_are_refused(tmp_path, monkeypatch):
    for planes, code in (
        ({"R": [[1.0]], "G": [[1.0]], "B": [[1.0]]}, "no-material-channels"),
        ({"skin": [[np.nan]]}, "invalid-weights"),
        ({"skin": [[-0.1]]}, "invalid-weights"),
    ):
        path = exr(tmp_path / "a.exr", **planes)
        with raises(TextureError, code) as caught:
            read_weights(path, NAMES)
        assert caught.value.path == path
    with raises(TextureError, "file-not-found"):
        read_weights(tmp_path / "none.png", NAMES)
    monkeypatch.setattr("uplift.design.palette.relight_viewer.picture_file.MAX_PIXELS", 2)
    with raises(TextureError, "image-too-large") as caught:
        read_weights(png(tmp_path / "a.png", [[SKIN, SKIN, SKIN]]), NAMES, LABELS)
    assert "got 3 × 1" in caught.value.problem
