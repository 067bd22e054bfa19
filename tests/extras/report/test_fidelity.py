"""Numbers of an assessment against slow reference implementations."""

import dataclasses

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import with_points, without_evidence
from uplift.atlas.resampling import on_grid
from uplift.colorimetry.observer import light
from uplift.extras.report.assessment import assess
from uplift.extras.report.entries import (
    WITHOUT_ATLAS,
    entry_errors,
    find_alternatives,
    find_crowding,
    own_entries,
)
from uplift.extras.report.measures import (
    MAX_LISTED,
    check_calibration,
    collect_failures,
)
from uplift.lookup.cube import Cube

OUTSIDE = "cyan"
"""The entry outside sRGB, which a lattice does not answer."""


def delta_e(first, second, name):
    """ΔE00 of two spectra (N,) under a light, as colour-science has it."""
    lit = light(name)
    labs = [
        colour.XYZ_to_Lab(lit.xyz @ spectrum, colour.XYZ_to_xy(lit.white))
        for spectrum in (first, second)
    ]
    return colour.delta_E(*labs, method="CIE 2000")


def test_entry_errors_match_colour_science(judged, small_cube, macbeth):
    atlas = small_cube.data.atlas
    nm = small_cube.wavelengths
    measured = dict(zip(macbeth.names, on_grid(macbeth, nm), strict=True))
    found = judged.entries
    assert sorted(found.names) == sorted((*atlas.names, OUTSIDE))
    for row, name in enumerate(found.names):
        if name != OUTSIDE:
            spectrum = small_cube.reflectance(atlas.rgb[atlas.names.index(name)])
            assert found.answers.answers[row] == pytest.approx(spectrum, abs=1e-12)
            expected = [
                delta_e(spectrum, measured[name], sensor.illuminant)
                for sensor in judged.lights
            ]
            assert found.answers.delta_e[row] == pytest.approx(expected, abs=1e-6)
            assert found.actual[row] == found.answers.delta_e[row, 1]


def test_without_an_atlas_there_are_no_entries(small_sigmoid_cube):
    found = assess(small_sigmoid_cube, "sigmoid.uplift", 1, None, ("A",))
    values = found.values
    assert found.entries is None
    assert values["atlas"]["files"] == values["entries"] == []
    assert values["crowding"] is values["standard_error"]["calibration"] is None
    assert sum(values["standard_error"]["delta_e_2000"]["counts"]) == 512


def test_crowding_matches_brute_force(crowded_cube):
    data = crowded_cube.data
    errors = entry_errors(crowded_cube, own_entries(data), [light("A")])
    found = find_crowding(data, errors)
    nodes = data.lattice.nodes
    steps = np.interp(data.atlas.rgb, nodes, np.arange(len(nodes)))
    apart = np.abs(steps[:, None] - steps).max(axis=2)
    np.fill_diagonal(apart, np.inf)
    nearest = dict(zip(data.atlas.names, apart.min(axis=1), strict=True))
    listed = dict(zip(found.entries.names, found.distances, strict=True))
    expected = {name: each for name, each in nearest.items() if each <= 1}
    assert listed == pytest.approx(expected)
    for name, other in zip(found.entries.names, found.nearest, strict=True):
        first, second = (data.atlas.names.index(each) for each in (name, other))
        assert apart[first, second] == pytest.approx(expected[name])
    assert (np.diff(found.entries.lattice.worst) <= 0).all()
    assert found.lost == []


def test_calibration_against_an_unknown_atlas(small_cube, repository):
    other = uplift.read_atlas(repository / "atlases" / "cie2017.txt")
    found = assess(small_cube, "small.uplift", 1, other, ("D65", "FL11", "A"))
    assert not found.values["atlas"]["own"]
    assert found.entries.lattice is found.entries.half_width is None
    measured = on_grid(other, small_cube.wavelengths)
    rgb = small_cube.data.sensor.rgb(measured)
    is_inside = ((rgb >= 0) & (rgb <= 1)).all(axis=1)
    rgb = rgb[is_inside]
    pairs = zip(small_cube.reflectance(rgb), measured[is_inside], strict=True)
    actual = np.array([delta_e(*pair, "A") for pair in pairs])
    error = small_cube.standard_error(rgb)
    expected = {
        "count": len(rgb),
        "real": error.mean() * np.quantile(actual / error, 0.68),
        "stated": error.mean(),
        "within_error": (actual <= error).mean(),
        "within_bound": (actual <= small_cube.error_bound(rgb)).mean(),
    }
    values = found.values["standard_error"]
    assert values["calibration"] == pytest.approx(expected, abs=1e-6)
    rgb = found.entries.rgb
    stated = [small_cube.standard_error(rgb, "FL11")]
    stated.append(small_cube.error_bound(rgb, "FL11"))
    errors = found.entries.answers.delta_e[:, 1]
    under = check_calibration(errors, np.transpose(stated))
    assert values["calibrations"] == {"FL11": under}
    assert values["unlike_atlas"] == small_cube.unlike_atlas(rgb).mean()


def test_own_entries_give_no_calibration(judged, plain_cube, macbeth):
    values = judged.values["standard_error"]
    assert (values["calibration"], values["calibrations"]) == (None, {})
    assert sum(values["delta_e_2000"]["counts"]) == 512
    earlier = without_evidence(plain_cube)
    unknowing = assess(earlier, "plain.uplift", 1, macbeth, ("A",)).values
    errors = unknowing["standard_error"]
    assert errors["delta_e_2000"] is errors["calibration"] is None


def test_failures_list_the_worst_points_first(spoilt, small_cube):
    assert collect_failures(small_cube.data)["over_threshold"] == 0
    found = collect_failures(spoilt.data)
    worst = [each["rgb"].tolist() for each in found["worst"]]
    assert worst == spoilt.data.lattice.points[[300, 100]].tolist()
    unknown = with_points(spoilt.data, distance=np.full(512, np.nan, np.float32))
    found = collect_failures(unknown)
    assert (found["over_threshold"], len(found["worst"])) == (512, MAX_LISTED)


def test_alternatives_have_the_colours_of_the_entries_inside_srgb(judged):
    sensor = judged.data.sensor
    inside = judged.entries.names != OUTSIDE
    for other in judged.alternatives.values():
        spectra = other.answers[inside]
        rgb = judged.entries.rgb[inside]
        assert_allclose(sensor.rgb(spectra), rgb, rtol=0, atol=2e-3)
        assert ((spectra >= 0) & (spectra <= 1)).all()


def test_colours_that_no_spectrum_of_the_lattice_has_have_no_answer(judged):
    inside = judged.entries.take(judged.entries.names != OUTSIDE)
    target = inside.target.copy()
    target[0] = judged.data.sensor.wavelengths > 600
    errors = dataclasses.replace(inside, target=target)
    other = find_alternatives(judged.data, errors, [light("A")])[WITHOUT_ATLAS]
    assert np.isnan(other.answers).all(axis=1).tolist() == [True] + 22 * [False]


def test_standard_errors_of_sparse_cubes_are_those_of_nodes_that_lookups_reach(
    plain_cube,
):
    data = plain_cube.data
    corners = data.lattice.corners(np.full((1, 3), 0.3))[0][0]
    points = data.points.restricted_to(corners)
    sparse = Cube(dataclasses.replace(data, points=points))
    found = assess(sparse, "sparse.uplift", 1, None, ("A",)).values
    count = sparse.covers(data.lattice.points[corners]).sum()
    assert sum(found["standard_error"]["delta_e_2000"]["counts"]) == count > 0
