"""Contact sheet: positions, colours and files."""

from itertools import product

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

from tests.cube.hand_made import hand_made
from uplift.extras.colour.srgb import encode
from uplift.extras.pages.sheet import STATUS, draw_sheet, write_sheet

CODES = np.array([list(bytes.fromhex(code[1:])) for code in STATUS]) / 255


def node(position):
    """Place of the node at (red, green, blue) in tiles of a lattice of 4³."""
    red, green, blue = position
    row, column = divmod(blue, 2)
    return 5 * row + 3 - green, 5 * column + red


def test_every_node_is_at_its_position():
    data = hand_made()
    axes = [axes for axes in draw_sheet(data).axes if axes.get_title(loc="left")]
    colours, distances, states, errors, rounds = (
        each.images[0].get_array() for each in axes
    )
    gaps = np.ma.getmaskarray(distances)
    assert np.flatnonzero(gaps.all(axis=0)).tolist() == [4]
    assert np.flatnonzero(gaps.all(axis=1)).tolist() == [4]
    low = data.threshold / 1000
    points = data.points
    for position in product(range(4), repeat=3):
        point = data.lattice.index(np.array(position))
        place = node(position)
        assert_allclose(colours[place], encode(points.rgb[point]))
        assert_allclose(states[place], CODES[points.status[point]])
        assert distances[place] == pytest.approx(max(points.distance[point], low))
        assert errors[place] == points.standard_error[point]
        if points.round[point] >= 0:
            assert rounds[place] == points.round[point]


def test_an_exr_sheet_has_one_part(tmp_path):
    write_sheet(hand_made(), tmp_path / "sheet.exr")
    (part,) = OpenEXR.File(str(tmp_path / "sheet.exr")).parts
    assert part.header["uplift.dim"] == 4
    pixels = part.channels["RGB"].pixels
    assert pixels.dtype == np.float32
    assert pixels.max() == 1
