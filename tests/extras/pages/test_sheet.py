"""Contact sheet: positions, colours and files."""

from itertools import combinations, product

import colour
import numpy as np
import OpenEXR
import pytest
from matplotlib.image import imread
from numpy.testing import assert_allclose

from tests.cube.hand_made import hand_made
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.pages.sheet import STATUS, draw_sheet, write_sheet

CODES = np.array([list(bytes.fromhex(code[1:])) for code in STATUS]) / 255
COLOUR, DISTANCE, STATE, ERROR, ROUND = (
    "Lattice RGB",
    "Fitting distance",
    "Status",
    "Standard error",
    "Round",
)


def shown(data):
    """The picture of each panel, by the beginning of its title."""
    images = {}
    for axes in draw_sheet(data).axes:
        if axes.get_title(loc="left"):
            (images[axes.get_title(loc="left").partition(",")[0]],) = axes.images
    return images


def node(position):
    """Place of the node at (red, green, blue) in tiles of a lattice of 4³."""
    red, green, blue = position
    row, column = divmod(blue, 2)
    return 5 * row + 3 - green, 5 * column + red


def test_every_node_is_at_its_position():
    data = hand_made()
    images = {name: image.get_array() for name, image in shown(data).items()}
    assert list(images) == [COLOUR, DISTANCE, STATE, ERROR, ROUND]
    gaps = np.ma.getmaskarray(images[DISTANCE])
    assert np.flatnonzero(gaps.all(axis=0)).tolist() == [4]
    assert np.flatnonzero(gaps.all(axis=1)).tolist() == [4]
    low = data.threshold / 1000
    for position in product(range(4), repeat=3):
        point = data.lattice.index(np.array(position))
        place = node(position)
        assert_allclose(images[COLOUR][place], encode(data.points.rgb[point]))
        assert_allclose(images[STATE][place], CODES[data.points.status[point]])
        distance = max(data.points.distance[point], low)
        assert images[DISTANCE][place] == pytest.approx(distance)
        assert images[ERROR][place] == data.points.standard_error[point]
        if data.points.round[point] >= 0:
            assert images[ROUND][place] == data.points.round[point]


def test_files_have_equal_pixels(tmp_path):
    data = hand_made()
    write_sheet(data, tmp_path / "sheet.exr")
    write_sheet(data, tmp_path / "sheet.png")
    file = OpenEXR.File(str(tmp_path / "sheet.exr"))
    image = file.channels()["RGB"].pixels
    assert len(file.parts) == 1
    assert file.header()["uplift.dim"] == 4
    assert image.dtype == np.float32
    assert_allclose(image, decode(imread(tmp_path / "sheet.png")[..., :3]), atol=1e-6)


@pytest.mark.parametrize("deficiency", ["Protanomaly", "Deuteranomaly", "Tritanomaly"])
@pytest.mark.filterwarnings("ignore::colour.utilities.ColourUsageWarning")
def test_status_colours_differ_for_colour_vision_deficiencies(deficiency):
    perceived = (
        decode(CODES) @ colour.blindness.matrix_cvd_Machado2009(deficiency, 1.0).T
    )
    labs = colour.XYZ_to_Lab(colour.RGB_to_XYZ(np.clip(perceived, 0, 1), "sRGB"))
    for one, other in combinations(labs, 2):
        assert colour.difference.delta_E_CIE2000(one, other) >= 16
