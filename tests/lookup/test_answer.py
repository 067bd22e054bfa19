"""What a query says, held against an independent computation."""

from __future__ import annotations

import colour
import numpy as np
import pytest

from uplift.lattice import Status
from uplift.lookup import answers

COLOURS = np.random.default_rng(12).random((40, 3))


@pytest.mark.parametrize("mode", ["spectra", "moments"])
def test_round_trip_and_difference_agree_with_colour_science(small_cube, mode):
    sensor = small_cube.data.sensor
    xy = colour.XYZ_to_xy(sensor.light.white)
    for answer in answers(small_cube, COLOURS, mode=mode):
        back = sensor.matrix @ answer.reflectance
        np.testing.assert_allclose(answer.round_trip, back, atol=1e-14)
        labs = [colour.XYZ_to_Lab(sensor.xyz(rgb), xy) for rgb in (answer.rgb, back)]
        assert answer.delta_e_2000 == pytest.approx(colour.difference.delta_E_CIE2000(*labs), abs=1e-9)


def test_the_answer_is_the_cube_s_at_any_wavelengths(small_cube):
    for answer in answers(small_cube, COLOURS, [444.4, 555.5]):
        np.testing.assert_allclose(
            answer.reflectance, small_cube.reflectance(answer.rgb, [444.4, 555.5]), atol=1e-12
        )


def test_the_cell_holds_the_colour_and_its_statuses(small_cube):
    data = small_cube.data
    for answer in answers(small_cube, COLOURS):
        low = np.array(answer.cell)
        assert (data.lattice.nodes[low] <= answer.rgb).all()
        assert (answer.rgb <= data.lattice.nodes[low + 1]).all()
        corners = data.lattice.corners(answer.rgb[None])[0][0]
        assert set(answer.statuses) == {Status(code) for code in data.status[corners]}


def test_an_entry_is_found_at_its_colour_and_at_its_8_bit_code_but_not_a_code_away(small_cube):
    atlas = small_cube.data.atlas
    codes = np.round(small_cube.encode(atlas.rgb))
    for shift, expected in ((0, list(atlas.names)), (1, [None] * len(atlas.names))):
        asked = small_cube.decode(codes + np.array([shift, 0, 0]))
        assert [answer.entry for answer in answers(small_cube, asked)] == expected
    assert [answer.entry for answer in answers(small_cube, atlas.rgb)] == list(atlas.names)


def test_without_an_atlas_there_are_no_entries(small_sigmoid_cube):
    assert {answer.entry for answer in answers(small_sigmoid_cube, COLOURS)} == {None}
