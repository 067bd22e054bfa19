"""Results of detailed queries, by RGB and by XYZ inside and outside the space of the
cube.
"""

from dataclasses import replace

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import MACBETH
from tests.helpers import query, query_xyz, raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.object_colours import solid
from uplift.colorimetry.observer import light
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import ColourError, UnknownNameError
from uplift.cube.file import write
from uplift.lattice.point_table import Status
from uplift.lookup.blocks import BLOCK
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES

D65_WAVELENGTHS = colour.SpectralShape(380, 780, 5)


def results_of(cube, *rgb, **options):
    return list(query(cube, np.array(rgb, dtype=float), **options))


def xyz(cube, reflectance):
    """XYZ by the integration of colour-science, with Y = 1 for the perfect
    reflector.
    """
    cmfs = (
        colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
        .copy()
        .align(D65_WAVELENGTHS)
    )
    light = colour.SDS_ILLUMINANTS["D65"].copy().align(D65_WAVELENGTHS)
    sd = colour.SpectralDistribution(reflectance, D65_WAVELENGTHS.wavelengths)
    return colour.sd_to_XYZ(sd, cmfs, light, method="Integration") / 100


def test_cell_and_statuses_are_those_around_the_colour(small_cube):
    data = small_cube.data
    grid = data.points.status.reshape(8, 8, 8)
    rgb = np.random.default_rng(5).random((100, 3))
    found_statuses = set()
    nodes = data.lattice.nodes
    for answer in query(small_cube, rgb):
        r, g, b = answer.cell
        assert (
            (nodes[[r, g, b]] <= answer.rgb)
            & (answer.rgb <= nodes[[r + 1, g + 1, b + 1]])
        ).all()
        around, _ = data.lattice.corners(answer.rgb[None])
        expected = sorted(set(grid.ravel()[around[0]].tolist()))
        assert [int(status) for status in answer.statuses] == expected
        found_statuses |= set(answer.statuses)
    assert {Status.ATLAS_PRIMARY, Status.REGULAR} <= found_statuses


def test_entries_are_found_at_their_nearest_codes_and_not_two_codes_away(small_cube):
    atlas = small_cube.data.atlas
    nearest = np.round(small_cube.encode(atlas.rgb))
    assert [
        answer.entry for answer in query(small_cube, small_cube.decode(nearest))
    ] == list(atlas.names)
    moved = (
        nearest + np.concatenate([2 * np.eye(3), -2 * np.eye(3)])[:, None]
    ).reshape(-1, 3)
    moved = moved[((moved >= 0) & (moved <= 255)).all(axis=1)]
    assert len(moved) > 90
    assert {answer.entry for answer in query(small_cube, small_cube.decode(moved))} == {
        None
    }


@pytest.mark.parametrize("mode", MODES)
def test_round_trip_and_difference_agree_with_colour_science(small_cube, mode):
    xy = colour.XYZ_to_xy(xyz(small_cube, np.ones(81)))
    to_rgb = small_cube.data.sensor.xyz_to_rgb
    differences = []
    for answer in query(
        small_cube, np.random.default_rng(8).random((10, 3)), mode=mode
    ):
        back = xyz(small_cube, answer.reflectance)
        assert_allclose(answer.round_trip, to_rgb @ back, rtol=0, atol=1e-12)
        queried = colour.XYZ_to_Lab(np.linalg.solve(to_rgb, answer.rgb), xy)
        differences.append(
            colour.delta_E(queried, colour.XYZ_to_Lab(back, xy), method="CIE 2000")
        )
        assert answer.delta_e_2000 == pytest.approx(differences[-1], abs=1e-9)
    assert max(differences) > 0.01 or mode in ("spectra", "refined")


def test_results_are_in_order_across_blocks(small_cube):
    rgb = np.random.default_rng(9).random((BLOCK + 3, 3))
    found = list(query(small_cube, rgb, [500.0]))
    assert_array_equal([answer.rgb for answer in found], rgb)
    expected = small_cube.reflectance(rgb[-3:], [500.0])
    assert_allclose(
        [answer.reflectance for answer in found[-3:]], expected, rtol=0, atol=1e-12
    )


def test_invalid_queries_are_refused(small_cube):
    with raises(ColourError, "rgb-out-of-gamut"):
        results_of(small_cube, (0.5, 0.5, 1.5))
    with raises(UnknownNameError, "unknown-name"):
        results_of(small_cube, (0.5, 0.5, 0.5), mode="exact")


def colours_outside(cube, count=200):
    """Return XYZ of smooth band-pass and band-stop reflectances that lie outside the
    space of a cube.
    """
    sensor = cube.data.sensor
    rng = np.random.default_rng(0)
    nm = sensor.wavelengths
    edges = np.sort(rng.uniform(380, 780, (count, 2, 1)), axis=1)
    width = rng.uniform(5, 40, (count, 1))
    band = (
        1
        / (1 + np.exp(-(nm - edges[:, 0]) / width))
        / (1 + np.exp((nm - edges[:, 1]) / width))
    )
    spectra = 0.02 + 0.96 * np.where(rng.random((count, 1)) < 0.5, band, 1 - band)
    rgb = sensor.rgb(spectra)
    return sensor.xyz(rgb[~in_unit_cube(rgb)])


def test_realisable_colours_outside_have_their_colour():
    cube = uplift.load()
    xyz = colours_outside(cube)
    assert len(xyz) > 20
    results = list(query_xyz(cube, xyz))
    spectra = np.array([result.reflectance for result in results])
    assert_allclose(spectra @ cube.data.sensor.light.xyz.T, xyz, rtol=0, atol=1e-6)
    assert ((spectra >= 0) & (spectra <= 1)).all()
    assert all(
        result.delta_e_2000 < 1e-3 and np.isnan(result.errors).all()
        for result in results
    )


def without_outside(cube):
    return Cube(replace(cube.data, atlas=replace(cube.data.atlas, outside=None)))


@pytest.mark.parametrize("digits", [4, 16])
def test_an_entry_outside_the_space_has_its_spectrum_and_its_colour(cyan_cube, digits):
    atlas = read_atlas(MACBETH)
    table = cyan_cube.data.atlas.outside
    measured = on_grid(atlas, cyan_cube.wavelengths)[[atlas.names.index("cyan")]]
    colour = xyz(cyan_cube, measured[0]).round(digits)
    (answer,) = query_xyz(cyan_cube, [colour], lights=[light("FL11")])
    assert (answer.entry, answer.errors) == ("cyan", [*table.error, *table.error])
    assert_allclose(xyz(cyan_cube, answer.reflectance), colour, rtol=0, atol=1e-7)
    for name in (cyan_cube.data.error_illuminant, "FL11"):
        stored = cyan_cube.data.atlas.outside.spectra.reflectance(
            np.array([0]), cyan_cube.wavelengths
        )
        own, found = (
            delta_e_spectra(light(name), each, measured)[0]
            for each in (stored, answer.reflectance[None])
        )
        assert found == pytest.approx(own, abs=1e-5 if digits == 16 else 0.1)
    assert answer.light_errors == {"FL11": pytest.approx([own, own], abs=1e-6)}
    assert without_outside(cyan_cube).data.atlas.outside is None


def test_files_without_its_measurement_have_its_error_under_their_own_light(
    cyan_cube, tmp_path
):
    table = cyan_cube.data.atlas.outside
    older = replace(
        cyan_cube.data,
        atlas=replace(cyan_cube.data.atlas, outside=replace(table, measured=None)),
    )
    for name, data, is_known in (("new", cyan_cube.data, True), ("old", older, False)):
        write(data, tmp_path / name)
        at = data.sensor.xyz(np.array([*table.rgb, [0.2, 0.3, 0.4]]))
        own, inside = query_xyz(
            uplift.load(tmp_path / name), at, lights=[light("FL11")]
        )
        assert np.isfinite(own.light_errors["FL11"]).all() == is_known
        assert np.isfinite(inside.light_errors["FL11"]).all()
        assert own.errors[0] == table.error[0]


def test_answers_change_only_in_the_box_of_an_entry_outside_and_continuously(cyan_cube):
    sensor = cyan_cube.data.sensor
    boxes = cyan_cube.data.outside_boxes
    assert boxes.rgb[0, 0] + boxes.half_width[0] <= 0
    for axis in np.eye(3):
        for share, is_same in (
            (0.5, False),
            (1 - 1e-9, False),
            (1 + 1e-9, True),
            (1.5, True),
        ):
            at = sensor.xyz(boxes.rgb - share * boxes.half_width[0] * axis)
            (found,), (other,) = (
                list(query_xyz(cube, at))
                for cube in (cyan_cube, without_outside(cyan_cube))
            )
            assert found.entry is None
            assert np.isnan(found.errors).all()
            assert np.abs(found.round_trip - found.rgb).max() < 1e-6
            change = np.abs(found.reflectance - other.reflectance).max()
            assert change == 0 if is_same else change < 1e-6 or share == 0.5
            assert share > 0.5 or change > 0.01


def test_other_colours_raise():
    cube = uplift.load()
    rgb = cube.data.sensor.xyz_to_rgb @ [0.05, 0.9, 0.1]
    assert not solid(cube.data.sensor.matrix).contains(rgb[None]).any()
    with raises(ColourError, "colour-unrealisable"):
        list(query_xyz(cube, [[0.05, 0.9, 0.1]]))
    with raises(ColourError, "colour"):
        list(query_xyz(cube, [[0.05, np.nan, 0.1]]))


def test_colours_are_realisable_if_the_solid_contains_them():
    """Also in cells whose corners are stand-ins that were not fitted, as in cubes of
    cameras.
    """
    cube = uplift.build(dim=6, space="camera", observer="Nikon 5100 (NPL)")
    rgb = np.concatenate(
        [[[0.0051, 0.1433, 0.4522]], np.random.default_rng(8).random((60, 3))]
    )
    expected = cube.data.solid.contains(rgb)
    assert 0 < expected.sum() < 60
    found = [answer.realisable for answer in query(cube, rgb)]
    assert_array_equal(found, expected)
