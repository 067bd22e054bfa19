"""Pictures of one's own: labels as colours or greys, and a renderer's weights."""

from __future__ import annotations

import matplotlib.image
import numpy as np
import OpenEXR
import pytest

from uplift.common.errors import OptionError, TextureError, UnknownNameError
from uplift.design.palette.relight_viewer import picture_file
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


def test_colours_are_materials_and_black_is_nothing(tmp_path):
    path = png(tmp_path / "a.png", [[SKIN, BONE, BLACK], [BONE, BONE, SKIN]])
    found = read_weights(path, NAMES, LABELS)
    assert found.dtype == np.float32
    assert found.tolist() == [[[1, 0], [0, 1], [0, 0]], [[0, 1], [0, 1], [1, 0]]]


def test_black_may_be_a_label_too(tmp_path):
    path = png(tmp_path / "a.png", [[SKIN, BLACK]])
    assert read_weights(path, NAMES, {**LABELS, "bone": "#000000"}).tolist() == [[[1, 0], [0, 1]]]


def test_greys_are_the_materials_in_order(tmp_path):
    path = png(tmp_path / "a.png", [[(0, 0, 0), (1, 1, 1), (2, 2, 2)]])
    assert read_weights(path, NAMES).tolist() == [[[0, 0], [1, 0], [0, 1]]]


def test_alpha_is_how_much_of_it_is_seen(tmp_path):
    path = png(tmp_path / "a.png", [[(*SKIN, 255), (*SKIN, 51), (*BONE, 0), (9, 9, 9, 0)]])
    assert read_weights(path, NAMES, LABELS)[0] == pytest.approx(np.array([[1, 0], [0.2, 0], [0, 0], [0, 0]]))


def test_channels_called_like_materials_are_their_weights(tmp_path):
    path = exr(tmp_path / "a.exr", bone=[[0.5, 1.5]], skin=[[0.25, 0]], Z=[[7, 8]])
    assert read_weights(path, NAMES).tolist() == [[[0.25, 0.5], [0, 1.5]]]
    path = exr(tmp_path / "b.exr", bone=[[0.5, 1.5]])
    assert read_weights(path, NAMES).tolist() == [[[0, 0.5], [0, 1.5]]]


@pytest.mark.parametrize(
    ("labels", "error", "told"),
    [
        ({"skim": "#ffffff"}, UnknownNameError, "unknown material 'skim'; did you mean 'skin'"),
        ({"skin": "orange"}, OptionError, "'orange' is no colour of 'skin'; write it as #rrggbb"),
        ({"skin": "#ffffff", "bone": "#FFFFFF"}, OptionError, "stands for two materials"),
    ],
)
def test_labels_that_cannot_be_meant_are_refused(tmp_path, labels, error, told):
    with pytest.raises(error, match=told):
        read_weights(png(tmp_path / "a.png", [[SKIN]]), NAMES, labels)


def test_colours_without_a_material_are_named(tmp_path):
    path = png(tmp_path / "a.png", [[SKIN, (1, 2, 3), (1, 2, 3), (9, 9, 9)]])
    with pytest.raises(TextureError, match=r"a\.png: 3 pixels have no material: #010203, #090909; give"):
        read_weights(path, NAMES, LABELS)


def test_images_that_are_neither_are_refused(tmp_path, monkeypatch):
    for planes, told in (
        ({"R": [[1.0]], "G": [[1.0]], "B": [[1.0]]}, "no channel called like a material"),
        ({"skin": [[np.nan]]}, "negative or not finite"),
        ({"skin": [[-0.1]]}, "negative or not finite"),
    ):
        with pytest.raises(TextureError, match=told) as caught:
            read_weights(exr(tmp_path / "a.exr", **planes), NAMES)
        assert "a.exr" in str(caught.value)
    with pytest.raises(TextureError, match="there is no such file"):
        read_weights(tmp_path / "none.png", NAMES)
    monkeypatch.setattr(picture_file, "MOST", 2)
    with pytest.raises(TextureError, match="is too large: 3 × 1; scale it"):
        read_weights(png(tmp_path / "a.png", [[SKIN, SKIN, SKIN]]), NAMES, LABELS)
