"""Contact sheet: positions, colours and legends."""

from itertools import combinations, product

import colour
import numpy as np
import OpenEXR
import pytest
from matplotlib.image import imread
from numpy.testing import assert_allclose, assert_array_equal

from tests.cube.hand_made import hand_made
from uplift.extras.colour.srgb import encode
from uplift.extras.pages.sheet import Layout, compose, write_sheet
from uplift.extras.pages.sheet_panels import (
    BACKGROUND,
    HIGHLIGHT,
    RAMP,
    STATUS,
    panels,
)

COLOUR, DISTANCE, STATE, ERROR, ROUND = range(5)


def pixel(data, image, panel, position):
    """Return the pixel in the middle of the node at ``position`` (red, green, blue)."""
    layout = Layout(data.lattice.dim, 5)
    red, green, blue = position
    x, y = layout.tile(panel, blue)
    half = layout.scale // 2
    row = y + (layout.dim - 1 - green) * layout.scale + half
    return image[row, x + red * layout.scale + half]


def test_every_node_is_at_its_position():
    data = hand_made()
    image = compose(data).image
    shown = panels(data)
    for position in product(range(4), repeat=3):
        point = data.lattice.index(np.array(position))
        for number, panel in enumerate(shown):
            assert_array_equal(
                pixel(data, image, number, position),
                panel.colours[point].astype(np.float32),
            )


def test_colours_agree_with_the_legend():
    data = hand_made()
    image = compose(data).image
    assert_array_equal(
        pixel(data, image, COLOUR, (3, 1, 2)), data.points.rgb[3 * 16 + 1 * 4 + 2]
    )
    assert_array_equal(
        pixel(data, image, DISTANCE, (0, 0, 0)), HIGHLIGHT[0].astype(np.float32)
    )
    for blue in range(4):
        assert_array_equal(
            pixel(data, image, STATE, (0, 0, blue)), STATUS[blue].astype("f4")
        )
    assert_array_equal(
        pixel(data, image, ROUND, (0, 0, 0)), HIGHLIGHT[0].astype(np.float32)
    )
    assert_array_equal(pixel(data, image, ROUND, (0, 0, 1)), RAMP[0].astype(np.float32))


@pytest.mark.parametrize(
    ("distance", "colour"),
    [
        (0.0, RAMP[0]),
        (1e-7, RAMP[0]),
        (10**-5.5, RAMP[2]),
        (1e-4, RAMP[-1]),
        (1.1e-4, HIGHLIGHT[0]),
    ],
)
def test_distance_is_logarithmic_up_to_the_threshold(distance, colour):
    panel = panels(hand_made(distance=np.full(64, distance)))[DISTANCE]
    assert_allclose(panel.colours, np.broadcast_to(colour, (64, 3)), atol=1e-9)


def test_exr_is_flat_linear_rgb(tmp_path):
    data = hand_made()
    write_sheet(data, tmp_path / "sheet.exr")
    file = OpenEXR.File(str(tmp_path / "sheet.exr"))
    image = file.channels()["RGB"].pixels
    assert len(file.parts) == 1
    assert file.header()["uplift.dim"] == 4
    assert image.dtype == np.float32
    for position in ((0, 0, 0), (3, 1, 2), (1, 3, 0)):
        expected = data.points.rgb[data.lattice.index(np.array(position))]
        assert_array_equal(pixel(data, image, COLOUR, position), expected)
    assert (image[0] == np.float32(BACKGROUND)).all()


def test_png_is_the_same_in_srgb(tmp_path):
    data = hand_made()
    write_sheet(data, tmp_path / "sheet.png")
    image = imread(tmp_path / "sheet.png")
    assert image.shape[1::-1] == Layout(4, 5).size
    for position in ((0, 0, 0), (3, 1, 2), (1, 3, 0)):
        expected = encode(data.points.rgb[data.lattice.index(np.array(position))])
        assert_allclose(
            pixel(data, image[..., :3], COLOUR, position), expected, atol=0.51 / 255
        )


@pytest.mark.parametrize("deficiency", ["Protanomaly", "Deuteranomaly", "Tritanomaly"])
@pytest.mark.filterwarnings("ignore::colour.utilities.ColourUsageWarning")
def test_status_colours_differ_for_colour_vision_deficiencies(deficiency):
    perceived = np.clip(
        STATUS @ colour.blindness.matrix_cvd_Machado2009(deficiency, 1.0).T, 0, 1
    )
    labs = colour.XYZ_to_Lab(colour.RGB_to_XYZ(perceived, "sRGB"))
    for one, other in combinations(labs, 2):
        assert colour.difference.delta_E_CIE2000(one, other) >= 16
