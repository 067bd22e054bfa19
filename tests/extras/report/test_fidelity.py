"""Numbers of an assessment against slow reference implementations."""

import dataclasses
import itertools

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.helpers import with_points, without_evidence
from uplift.atlas.resampling import on_grid
from uplift.colorimetry.observer import light
from uplift.extras.report.assessment import assess
from uplift.extras.report.entries import (
    JAKOB_HANIKA,
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
    compute_smoothness,
)
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import lattice_spectra
from uplift.models.model import reflectance

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
    measured = dict(
        zip(
            macbeth.names,
            on_grid(macbeth, small_cube.data.sensor.wavelengths),
            strict=True,
        )
    )
    atlas = small_cube.data.atlas
    found = judged.entries
    assert sorted(found.names) == sorted((*atlas.names, OUTSIDE))
    for row, name in enumerate(found.names):
        if name == OUTSIDE:
            continue
        own = atlas.names.index(name)
        answered = small_cube.reflectance(atlas.rgb[own])
        assert found.answers.answers[row] == pytest.approx(answered, abs=1e-12)
        assert found.answers.rms[row] == pytest.approx(
            np.sqrt(np.mean((answered - measured[name]) ** 2)), rel=1e-9
        )
        assert found.actual[row] == pytest.approx(
            delta_e(answered, measured[name], "A"), abs=1e-6
        )
        assert found.predicted[row] == pytest.approx(atlas.error[own], abs=1e-12)
        assert found.half_width[row] == atlas.half_width[own]
        for column, sensor in enumerate(judged.lights):
            expected = delta_e(answered, measured[name], sensor.illuminant)
            assert found.answers.delta_e[row, column] == pytest.approx(
                expected, abs=1e-6
            )


def test_lattice_errors_are_those_of_the_lattice_without_the_entries(
    judged, small_cube, macbeth
):
    data = small_cube.data
    found = judged.entries
    measured = dict(
        zip(macbeth.names, on_grid(macbeth, data.sensor.wavelengths), strict=True)
    )
    inside = [row for row, name in enumerate(found.names) if name != OUTSIDE]
    spectra = lattice_spectra(
        data.model,
        data.lattice,
        data.points,
        found.rgb[inside],
        data.sensor.wavelengths,
    )
    assert_allclose(found.lattice.answers[inside], spectra, atol=1e-12)
    for row, spectrum in zip(inside, spectra, strict=True):
        missed = [
            delta_e(spectrum, measured[found.names[row]], sensor.illuminant)
            for sensor in judged.lights
        ]
        assert found.lattice.delta_e[row] == pytest.approx(missed, abs=1e-6)
    assert (found.lattice.worst > found.answers.worst + 0.1).any()


def test_entries_of_another_atlas_have_no_lattice_errors(small_cube, repository):
    other = uplift.read_atlas(repository / "atlases" / "babelcolor.txt")
    found = assess(small_cube, "small.uplift", 1, other, ("D65", "A"))
    atlas = found.values["atlas"]
    assert (atlas["own"], atlas["files"]) == (False, ["babelcolor.txt"])
    own = ("lattice", "half_width", "half_width_codes")
    assert {getattr(found.entries, name) for name in own} == {None}
    assert sorted((*found.entries.names, *atlas["outside"])) == sorted(other.names)


def test_without_an_atlas_there_are_no_entries(small_sigmoid_cube):
    found = assess(small_sigmoid_cube, "sigmoid.uplift", 1, None, ("A",))
    values = found.values
    assert found.entries is None
    assert values["atlas"]["files"] == values["entries"] == []
    assert values["crowding"] is values["standard_error"]["calibration"] is None
    assert sum(values["standard_error"]["delta_e_2000"]["counts"]) == 512


def test_smoothness_matches_explicit_loops(small_cube, small_sigmoid_cube):
    for data in (small_cube.data, small_sigmoid_cube.data):
        spectra = reflectance(
            data.model, data.points.coefficients, data.sensor.wavelengths
        ).reshape(8, 8, 8, -1)
        expected = {}
        for first in itertools.product(range(8), repeat=3):
            for step in np.eye(3, dtype=int):
                second = tuple(first + step)
                if max(second) < 8:
                    change = spectra[first] - spectra[second]
                    expected[first, second] = np.sqrt(np.mean(change**2))
        differences, steepest_rgb = compute_smoothness(data)
        assert_allclose(np.sort(differences), sorted(expected.values()), rtol=1e-5)
        steepest = np.array(max(expected, key=expected.get))
        assert_array_equal(steepest_rgb, data.lattice.nodes[steepest])


def test_crowding_matches_brute_force(crowded_cube):
    data = crowded_cube.data
    errors = entry_errors(crowded_cube, own_entries(data), [light("A")])
    found = find_crowding(data, errors)
    nodes = data.lattice.nodes
    names = data.atlas.names
    steps = np.interp(data.atlas.rgb, nodes, np.arange(len(nodes)))
    expected = {}
    for row, name in enumerate(names):
        apart = {
            other: np.abs(steps[row] - steps[i]).max()
            for i, other in enumerate(names)
            if i != row
        }
        if min(apart.values()) <= 1:
            expected[name] = min(apart.values())
    listed = dict(zip(found.entries.names, found.distances, strict=True))
    assert listed == pytest.approx(expected)
    for name, other in zip(found.entries.names, found.nearest, strict=True):
        apart = np.abs(steps[names.index(name)] - steps[names.index(other)]).max()
        assert (name != other, apart) == (True, pytest.approx(expected[name]))
    assert len(expected) > 0
    assert found.entries.lattice.worst.tolist() == sorted(
        found.entries.lattice.worst, reverse=True
    )
    assert found.lost == []


def test_calibration_against_an_unknown_atlas(small_cube, repository):
    other = uplift.read_atlas(repository / "atlases" / "cie2017.txt")
    found = assess(small_cube, "small.uplift", 1, other, ("D65", "FL11", "A"))
    ratios = []
    errors = []
    within = 0
    bounded = 0
    for entry in other.entries:
        (measured,) = on_grid(uplift.Atlas((entry,)), small_cube.wavelengths)
        rgb = small_cube.data.sensor.rgb(measured)
        if rgb.min() < 0 or rgb.max() > 1:
            continue
        actual = delta_e(small_cube.reflectance(rgb), measured, "A")
        error = float(small_cube.standard_error(rgb))
        ratios.append(actual / error)
        errors.append(error)
        within += actual <= error
        bounded += actual <= small_cube.error_bound(rgb)
    count = len(ratios)
    mean = sum(errors) / count
    expected = {
        "count": count,
        "real": mean * np.quantile(ratios, 0.68),
        "stated": mean,
        "within_error": within / count,
        "within_bound": bounded / count,
    }
    values = found.values["standard_error"]
    assert values["calibration"] == pytest.approx(expected, abs=1e-6)
    assert count == len(found.entries.names)
    # These materials are unlike the ColorChecker.
    assert values["calibration"]["real"] > values["calibration"]["stated"]
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
    assert values["unlike_atlas"] == 0
    assert sum(values["delta_e_2000"]["counts"]) == 512
    # Stored errors are not limited by possible ones.
    mean = values["delta_e_2000"]["mean"]
    assert 0.9 < mean / judged.values["build"]["mean_standard_error"] < 1
    earlier = without_evidence(plain_cube)
    unknowing = assess(earlier, "plain.uplift", 1, macbeth, ("A",)).values
    assert unknowing["build"]["mean_standard_error"] is None
    errors = unknowing["standard_error"]
    assert errors["delta_e_2000"] is errors["calibration"] is None


def test_failures_list_the_worst_points_first(spoilt, small_cube):
    assert collect_failures(small_cube.data)["over_threshold"] == 0
    found = collect_failures(spoilt.data)
    worst = spoilt.data.lattice.points[[300, 100]].tolist()
    assert (
        found["over_threshold"],
        [each["rgb"].tolist() for each in found["worst"]],
    ) == (2, worst)
    assert found["left_out"] == ()  # the cyan is kept
    nothing = dataclasses.replace(
        with_points(spoilt.data, distance=np.full(512, np.nan, np.float32)),
        provenance={},
    )
    found = collect_failures(nothing)
    assert (found["over_threshold"], len(found["worst"])) == (512, MAX_LISTED)


def test_all_have_the_colours_of_the_entries(judged):
    sensor = judged.data.sensor
    for other in judged.alternatives.values():
        inside = np.array(judged.entries.names) != OUTSIDE
        spectra = other.answers[inside]
        assert_allclose(
            sensor.rgb(spectra), judged.entries.rgb[inside], rtol=0, atol=2e-3
        )
        assert spectra.min() >= 0
        assert spectra.max() <= 1


def test_jakob_hanika_is_a_sigmoid_of_a_parabola(judged):
    answer = judged.alternatives[JAKOB_HANIKA].answers
    t = 2 * answer - 1
    linear = t / np.sqrt(1 - t**2)  # inverse of equation 5
    wavelengths = judged.data.sensor.wavelengths
    fit = np.polynomial.polynomial.polyfit(wavelengths, linear.T, 2)
    scale = np.abs(linear).max(axis=1, keepdims=True)
    parabola = np.polynomial.polynomial.polyval(wavelengths, fit)
    assert np.abs(parabola - linear).max() <= 1e-6 * scale.max()


def test_the_atlas_helps(judged):
    lit = slice(1, None)  # all but the light that colours are matched under
    for other in judged.alternatives.values():
        assert judged.entries.answers.delta_e[:, lit].mean() < np.nanmean(
            other.delta_e[:, lit]
        )


def test_colours_outside_srgb_have_no_answer(judged):
    inside = judged.entries.take(judged.entries.names != OUTSIDE)
    target = inside.target.copy()
    target[0] = np.where(judged.data.sensor.wavelengths > 600, 1.0, 0.0)
    errors = dataclasses.replace(inside, target=target)
    other = find_alternatives(judged.data, errors, [light("A")])[WITHOUT_ATLAS]
    assert np.isnan(other.delta_e[0]).all()
    assert np.isnan(other.answers[0]).all()
    assert np.isfinite(other.delta_e[1:]).all()
    assert np.isfinite(other.answered).all()


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
