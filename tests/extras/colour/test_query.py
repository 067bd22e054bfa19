"""Results of detailed queries, by RGB and by XYZ inside and outside the space of the
cube.
"""

from dataclasses import replace

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import expit

import uplift
from tests.conftest import MACBETH
from tests.fuzz.builds import little_work
from tests.helpers import query, query_xyz, raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import ColourError, UnknownNameError
from uplift.lookup.blocks import BLOCK
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES

D65_GRID = colour.SpectralShape(380, 780, 5)
CMFS = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(D65_GRID)
D65 = colour.SDS_ILLUMINANTS["D65"].copy().align(D65_GRID)


def xyz(reflectance):
    """XYZ by the integration of colour-science, with Y = 1 for the perfect
    reflector.
    """
    sd = colour.SpectralDistribution(reflectance, D65_GRID.wavelengths)
    return colour.sd_to_XYZ(sd, CMFS, D65, method="Integration") / 100


def test_cell_and_statuses_are_those_around_the_colour(small_cube):
    data = small_cube.data
    nodes = data.lattice.nodes
    for answer in query(small_cube, np.random.default_rng(5).random((100, 3))):
        low = np.array(answer.cell)
        assert (nodes[low] <= answer.rgb).all()
        assert (answer.rgb <= nodes[low + 1]).all()
        around, _ = data.lattice.corners(answer.rgb[None])
        assert_array_equal(answer.statuses, np.unique(data.points.status[around]))


def test_entries_are_found_at_their_nearest_codes_and_not_two_codes_away(small_cube):
    atlas = small_cube.data.atlas
    nearest = np.round(small_cube.encode(atlas.rgb))
    found = query(small_cube, small_cube.decode(nearest))
    assert [answer.entry for answer in found] == list(atlas.names)
    moved = small_cube.decode(nearest + np.where(nearest < 128, 2, -2))
    assert {answer.entry for answer in query(small_cube, moved)} == {None}


@pytest.mark.parametrize("mode", MODES)
def test_round_trip_and_difference_agree_with_colour_science(small_cube, mode):
    xy = colour.XYZ_to_xy(xyz(np.ones(81)))
    to_rgb = small_cube.data.sensor.xyz_to_rgb
    for answer in query(small_cube, np.random.default_rng(8).random((4, 3)), mode=mode):
        back = xyz(answer.reflectance)
        assert_allclose(answer.round_trip, to_rgb @ back, rtol=0, atol=1e-12)
        queried = colour.XYZ_to_Lab(np.linalg.solve(to_rgb, answer.rgb), xy)
        shown = colour.XYZ_to_Lab(back, xy)
        difference = colour.delta_E(queried, shown, method="CIE 2000")
        assert answer.delta_e_2000 == pytest.approx(difference, abs=1e-9)


def test_results_are_in_order_across_blocks(small_cube):
    rgb = np.random.default_rng(9).random((BLOCK + 3, 3))
    found = list(query(small_cube, rgb, [500.0]))
    assert_array_equal([answer.rgb for answer in found], rgb)
    last = [answer.reflectance for answer in found[-3:]]
    assert_allclose(last, small_cube.reflectance(rgb[-3:], [500.0]), atol=1e-12)


@pytest.mark.parametrize(
    ("red", "mode", "error"),
    [(1.5, "spectra", ColourError), (0.5, "exact", UnknownNameError)],
)
def test_invalid_queries_are_refused(small_cube, red, mode, error):
    with raises(error):
        list(query(small_cube, [[red, 0.5, 0.5]], mode=mode))


def colours_outside(cube):
    """Return XYZ of smooth band-stop reflectances that lie outside the
    space of a cube.
    """
    nm = cube.data.sensor.wavelengths
    rng = np.random.default_rng(0)
    low = rng.uniform(380, 580, (200, 1))
    high = rng.uniform(500, 780, (200, 1))
    width = rng.uniform(5, 40, (200, 1))
    band = expit((nm - low) / width) * expit((high - nm) / width)
    rgb = cube.data.sensor.rgb(0.98 - 0.96 * band)
    return cube.data.sensor.xyz(rgb[~in_unit_cube(rgb)])


def test_realisable_colours_outside_have_their_colour():
    cube = uplift.load()
    xyz = colours_outside(cube)
    assert len(xyz) > 20
    results = query_xyz(cube, xyz)
    spectra = np.array([result.reflectance for result in results])
    assert_allclose(spectra @ cube.data.sensor.light.xyz.T, xyz, rtol=0, atol=1e-6)
    assert ((spectra >= 0) & (spectra <= 1)).all()
    assert max(result.delta_e_2000 for result in results) < 1e-3
    assert np.isnan([result.errors for result in results]).all()


@pytest.mark.parametrize(("digits", "tolerance"), [(4, 0.1), (16, 1e-5)])
def test_an_entry_outside_the_space_has_its_spectrum_and_its_colour(
    cyan_cube, digits, tolerance
):
    atlas = read_atlas(MACBETH)
    table = cyan_cube.data.atlas.outside
    row = atlas.names.index("cyan")
    measured = on_grid(atlas, cyan_cube.wavelengths)[row]
    requested = xyz(measured).round(digits)
    (answer,) = query_xyz(cyan_cube, [requested], lights=[light("FL11")])
    assert (answer.entry, answer.errors) == ("cyan", [*table.error, *table.error])
    assert_allclose(xyz(answer.reflectance), requested, rtol=0, atol=1e-7)
    (stored,) = table.spectra.reflectance(np.array([0]), cyan_cube.wavelengths)
    own = delta_e_spectra(light("FL11"), stored, measured)
    found = delta_e_spectra(light("FL11"), answer.reflectance, measured)
    assert found == pytest.approx(own, abs=tolerance)
    assert answer.light_errors == {"FL11": pytest.approx([own, own], abs=1e-6)}


def test_files_without_its_measurement_do_not_know_its_error(cyan_cube):
    atlas = cyan_cube.data.atlas
    older = replace(atlas, outside=replace(atlas.outside, measured=None))
    cube = Cube(replace(cyan_cube.data, atlas=older))
    at = cube.data.sensor.xyz(atlas.outside.rgb)
    (answer,) = query_xyz(cube, at, lights=[light("FL11")])
    assert np.isnan(answer.light_errors["FL11"]).all()
    assert answer.errors[0] == atlas.outside.error[0]


def without_outside(cube):
    return Cube(replace(cube.data, atlas=replace(cube.data.atlas, outside=None)))


@pytest.mark.parametrize(
    ("share", "least", "most"), [(0.5, 0.01, 1), (1 - 1e-9, 0, 1e-6), (1 + 1e-9, 0, 0)]
)
def test_answers_change_only_in_the_box_of_an_entry_outside_and_continuously(
    cyan_cube, share, least, most
):
    boxes = cyan_cube.data.outside_boxes
    rgb = boxes.rgb - share * boxes.half_width[0] * np.eye(3)
    at = cyan_cube.data.sensor.xyz(rgb)
    others = query_xyz(without_outside(cyan_cube), at)
    for found, other in zip(query_xyz(cyan_cube, at), others, strict=True):
        assert found.entry is None
        assert np.abs(found.round_trip - found.rgb).max() < 1e-6
        assert least <= np.abs(found.reflectance - other.reflectance).max() <= most


@pytest.mark.parametrize(
    ("y", "code"), [(0.9, "colour-unrealisable"), (np.nan, "colour")]
)
def test_other_colours_raise(y, code):
    with raises(ColourError, code):
        query_xyz(uplift.load(), [[0.05, y, 0.1]])


def test_colours_are_realisable_if_the_solid_contains_them():
    """Also in cells whose corners are stand-ins that were not fitted, as in cubes of
    cameras.
    """
    sensor = {"space": "camera", "observer": "Nikon 5100 (NPL)"}
    with little_work():
        cube = uplift.build(dim=4, prior="smooth", **sensor)
    rgb = np.random.default_rng(8).random((60, 3))
    expected = cube.data.solid.contains(rgb)
    assert 0 < expected.sum() < 60
    assert_array_equal([answer.realisable for answer in query(cube, rgb)], expected)
