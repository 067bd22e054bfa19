"""Pictures from files: labels as colours or greys, and float weights; layers of the
ball are where rays meet them.
"""

import matplotlib.image
import numpy as np
import pytest

from tests.extras.texture.conftest import write_exr
from tests.helpers import raises
from uplift.common.errors import OptionError, TextureError, UnknownNameError
from uplift.extras.papers.palette import picture
from uplift.extras.papers.palette.picture import cutaway, read_weights

NAMES = ("skin", "bone")
LABELS = {"skin": "#ff8000", "bone": "#00ff10"}
SKIN = (255, 128, 0)
BONE = (0, 255, 16)
BLACK = (0, 0, 0)


def png(path, pixels):
    matplotlib.image.imsave(path, np.array(pixels, dtype=np.uint8))
    return path


def exr(path, **planes):
    return write_exr(path, {name: np.float32(planes[name]) for name in planes})


@pytest.mark.parametrize(
    ("pixels", "labels", "weights"),
    [
        ([SKIN, BONE, BLACK], LABELS, [[1, 0], [0, 1], [0, 0]]),  # black is empty
        ([SKIN, BLACK], LABELS | {"bone": "#000000"}, [[1, 0], [0, 1]]),
        ([BLACK, (1, 1, 1), (2, 2, 2)], None, [[0, 0], [1, 0], [0, 1]]),
        ([(*SKIN, 255), (*SKIN, 51), (*BONE, 0)], LABELS, [[1, 0], [0.2, 0], [0, 0]]),
    ],
    ids=["labels", "black", "greys", "alpha"],
)
def test_colours_are_labels_and_alpha_is_the_weight(tmp_path, pixels, labels, weights):
    found = read_weights(png(tmp_path / "a.png", [pixels]), NAMES, labels)
    assert found.dtype == np.float32
    assert found[0] == pytest.approx(np.array(weights))


def test_channels_named_after_materials_are_their_weights(tmp_path):
    path = exr(tmp_path / "a.exr", bone=[[0.5, 1.5]], Z=[[7, 8]])
    assert read_weights(path, NAMES).tolist() == [[[0, 0.5], [0, 1.5]]]


@pytest.mark.parametrize(
    ("content", "labels", "error"),
    [
        ([[SKIN]], {"skim": "#ffffff"}, UnknownNameError),
        ([[SKIN]], {"skin": "orange"}, OptionError),
        ([[SKIN]], {"skin": "#ffffff", "bone": "#FFFFFF"}, OptionError),
        ([[SKIN, (1, 2, 3)]], LABELS, TextureError),
        ([[SKIN] * 11], LABELS, TextureError),
        ({"R": [[1.0]]}, None, TextureError),
        ({"skin": [[np.nan]]}, None, TextureError),
        ({"skin": [[-0.1]]}, None, TextureError),
    ],
)
def test_unusable_pictures_and_labels_are_refused(
    tmp_path, monkeypatch, content, labels, error
):
    monkeypatch.setattr(picture, "MAX_PIXELS", 10)
    if isinstance(content, dict):
        path = exr(tmp_path / "a.exr", **content)
    else:
        path = png(tmp_path / "a.png", content)
    with raises(error) as caught:
        read_weights(path, NAMES, labels)
    assert caught.value.path == (path if error is TextureError else None)


@pytest.mark.parametrize("count", [1, 3, 24])
def test_every_material_is_visible_and_weights_sum_to_at_most_1(count):
    weights = cutaway(count, size=160)
    assert weights.min() == 0
    assert 0.8 < weights.sum(axis=-1).max() <= 1
    assert (weights.max(axis=(0, 1)) > 0.5).all()
    assert not weights[0].any()
