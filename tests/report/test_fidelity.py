"""The numbers of a report, against slow and plain ways to find them."""

from __future__ import annotations

import dataclasses
import itertools

import colour
import numpy as np
import pytest

import uplift
from uplift.atlas import on_grid
from uplift.errors import UnknownNameError
from uplift.lattice import Status
from uplift.lookup import MODES, Cube
from uplift.models import reflectance
from uplift.observer import light
from uplift.report.assessment import assess
from uplift.report.crowding import crowds
from uplift.report.failures import NAMED, failures
from uplift.report.fidelity import COLOURS, about_other, about_own, about_stored, entries, round_trips
from uplift.report.histogram import histogram, linear_edges, log_edges
from uplift.report.smoothness import smoothness
from uplift.report.viewing import LIGHTS, hex_codes, viewings


def delta_e(first, second, name):
    """ΔE00 of two spectra (N,) under a light, as colour-science has it."""
    lit = light(name)
    labs = [
        colour.XYZ_to_Lab(lit.xyz @ spectrum, colour.XYZ_to_xy(lit.white)) for spectrum in (first, second)
    ]
    return colour.delta_E(*labs, method="CIE 2000")


def test_every_entry_s_errors(judged, small_cube, macbeth):
    measured = dict(zip(macbeth.names, on_grid(macbeth, small_cube.data.sensor.wavelengths), strict=True))
    atlas = small_cube.data.atlas
    stored = reflectance(small_cube.data.model, atlas.coefficients, small_cube.data.sensor.wavelengths)
    found = judged.entries
    assert sorted(found.names) == sorted(atlas.names)
    for row, name in enumerate(found.names):
        own = atlas.names.index(name)
        answered = small_cube.reflectance(atlas.rgb[own])
        assert found.answered[row] == pytest.approx(answered, abs=1e-12)
        assert found.rms[row] == pytest.approx(np.sqrt(np.mean((answered - measured[name]) ** 2)), rel=1e-9)
        assert found.rms_stored[row] == pytest.approx(
            np.sqrt(np.mean((answered - stored[own]) ** 2)), rel=1e-9
        )
        for column, seen in enumerate(judged.lights):
            expected = delta_e(answered, measured[name], seen.illuminant)
            assert found.delta_e[row, column] == pytest.approx(expected, abs=1e-6)
            expected = delta_e(stored[own], measured[name], seen.illuminant)
            assert found.delta_e_stored[row, column] == pytest.approx(expected, abs=1e-6)


def test_the_worst_comes_first(judged):
    worst = judged.entries.delta_e.max(axis=1)
    assert (np.diff(worst) <= 0).all()
    assert judged.entries.worst.tolist() == worst.tolist()
    assert judged.entries.worst[0] > 0


def test_own_weights_and_corners(judged, small_cube):
    data = small_cube.data
    for row, name in enumerate(judged.entries.names):
        (points,), (weights,) = data.lattice.corners(judged.entries.rgb[row : row + 1])
        own = [data.atlas.names[data.entry[point]] == name for point in points]
        assert judged.entries.own[row] == pytest.approx(sum(weights[own]), abs=1e-12)
        counts = [sum(data.status[point] == status for point in points) for status in Status]
        assert judged.entries.corners[row].tolist() == counts


def test_entries_of_another_atlas_have_nothing_stored(small_cube, repository):
    other = uplift.read_atlas(repository / "atlases" / "babelcolor.txt")
    found = assess(small_cube, "small.uplift", 1, other, ("D65", "A"))
    assert not found.own
    assert found.sources == ("babelcolor.txt",)
    assert (found.entries.stored, found.entries.rms_stored, found.entries.own) == (None, None, None)
    assert sorted((*found.entries.names, *found.outside)) == sorted(other.names)
    name = found.entries.names[0]
    (measured,) = on_grid(uplift.Spectra((other.entries[other.names.index(name)],)), small_cube.wavelengths())
    assert found.entries.rgb[0] == pytest.approx(small_cube.data.sensor.rgb(measured), abs=1e-12)
    assert found.entries.delta_e[0, 1] == pytest.approx(
        delta_e(found.entries.answered[0], measured, "A"), abs=1e-6
    )


def test_the_cube_s_own_atlas_is_known_by_its_content(judged, small_cube, macbeth):
    assert judged.own
    assert judged.outside == ("cyan",)
    assert about_own(small_cube.data, macbeth).names == about_other(small_cube.data, macbeth).names


def test_no_atlas_no_entries(small_sigmoid_cube):
    found = assess(small_sigmoid_cube, "sigmoid.uplift", 1, None, ("A",))
    assert (found.entries, found.delta_e, found.crowds, found.sources) == (None, {}, (), ())


def test_an_atlas_that_the_space_does_not_hold_gives_no_entries(small_cube, hostile):
    laser = dataclasses.replace(hostile, entries=hostile.entries[1:])
    found = assess(small_cube, "small.uplift", 1, laser, ("A",))
    assert found.entries is None
    assert found.outside == laser.names


def test_round_trips_are_the_same_colours_every_time(small_cube):
    found = round_trips(small_cube)
    assert found.keys() == MODES.keys()
    assert {len(values) for values in found.values()} == {COLOURS}
    assert found["spectra"].max() < 0.01
    assert found["refined"].max() < 0.01 < found["moments"].max()
    again = round_trips(small_cube)
    assert all(np.array_equal(found[mode], again[mode]) for mode in MODES)


@pytest.mark.parametrize("model", ["moments", "sigmoid"])
def test_smoothness_by_loops(model):
    data = uplift.build(dim=4, model=model, **({"coefficients": 5} if model == "moments" else {})).data
    spectra = reflectance(data.model, data.coefficients, data.sensor.wavelengths).reshape(4, 4, 4, -1)
    expected = {}
    for first in itertools.product(range(4), repeat=3):
        for axis in range(3):
            second = tuple(place + (axis == i) for i, place in enumerate(first))
            if max(second) < 4:
                expected[first, second] = np.sqrt(np.mean((spectra[first] - spectra[second]) ** 2))
    found = smoothness(data)
    assert np.sort(found.differences) == pytest.approx(sorted(expected.values()), rel=1e-5)
    steepest = max(expected, key=expected.get)
    assert {tuple(rgb) for rgb in found.steepest.tolist()} == {
        tuple(data.lattice.nodes[list(place)].tolist()) for place in steepest
    }


def test_crowds_by_brute_force(crowded_cube):
    data, lights = crowded_cube.data, viewings(("A",), crowded_cube.data.sensor.observer)
    asked = entries(crowded_cube, about_stored(data), lights)
    nodes = data.lattice.nodes

    def voxel(rgb):
        return tuple(min(max(i for i, node in enumerate(nodes) if node <= value), 2) for value in rgb)

    by_voxel = {}
    for name, rgb in zip(data.atlas.names, data.atlas.rgb, strict=True):
        by_voxel.setdefault(voxel(rgb), set()).add(name)
    found = crowds(data.lattice, asked)
    assert {crowd.cell: set(crowd.entries.names) for crowd in found} == {
        cell: names for cell, names in by_voxel.items() if len(names) > 1
    }
    assert found
    for crowd in found:
        assert (crowd.entries.rgb >= crowd.bounds[0]).all()
        assert (crowd.entries.rgb <= crowd.bounds[1]).all()
    worst = [crowd.entries.worst[0] for crowd in found]
    assert worst == sorted(worst, reverse=True)


def test_entries_that_nobody_measured_are_held_against_what_is_stored(crowded_cube, hostile):
    found = assess(crowded_cube, "small.uplift", 1, hostile, ("D65",))
    assert not found.own
    assert found.crowds
    assert found.crowds[0].entries.rms.tolist() == found.crowds[0].entries.rms_stored.tolist()


def test_failures_name_the_worst(spoilt, small_cube):
    assert failures(small_cube.data).missed == 0
    found = failures(spoilt.data)
    assert (found.missed, found.points.tolist()) == (2, [300, 100])
    assert found.counts["unfitted"] == 2
    assert found.left_out == ("cyan",)
    nothing = dataclasses.replace(spoilt.data, distance=np.full(512, np.nan, np.float32), provenance={})
    assert (failures(nothing).missed, len(failures(nothing).points)) == (512, NAMED)


def test_histograms_lose_nothing():
    values = np.array([0.0, 1e-12, 3e-7, 0.2, 0.2, 5.0])
    for edges in (log_edges(values, 1e-9), linear_edges(values)):
        found = histogram(values, edges)
        assert found.counts.sum() == 6
        assert (np.diff(edges) > 0).all()
        assert (found.mean, found.largest) == (values.mean(), 5.0)
        assert edges[-1] >= 5
    assert histogram(values, log_edges(values, 1e-9)).logarithmic
    assert not histogram(values, linear_edges(values)).logarithmic


@pytest.mark.parametrize("value", [0.0, 1e-15, 1.0, 0.024, 24.0, 777.0])
def test_edges_hold_any_values(value):
    for edges in (log_edges([value], 1e-9), linear_edges([value])):
        assert len(edges) >= 2
        assert (np.diff(edges) > 0).all()
        assert edges[-1] >= value * (1 - 1e-9)


def test_each_light_once_and_white_is_white_under_all():
    lights = viewings((*LIGHTS, "d65", "A"), colour.MSDS_CMFS["cie_2_1931"].name)
    assert [seen.illuminant for seen in lights] == list(LIGHTS)
    for seen in lights:
        assert hex_codes(seen.rgb(np.ones((1, 81)))) == ["#ffffff"]
        assert hex_codes(seen.rgb(np.zeros((1, 81)))) == ["#000000"]


def test_an_unknown_light_is_refused(small_cube):
    with pytest.raises(UnknownNameError, match="unknown illuminant 'D66'; did you mean"):
        assess(small_cube, "small.uplift", 1, None, ("D65", "D66"))


def test_a_cube_without_a_history_can_be_judged(small_cube, macbeth):
    silent = Cube(dataclasses.replace(small_cube.data, provenance={}))
    found = assess(silent, "small.uplift", 1, macbeth, ("A",))
    assert not found.own
    assert len(found.entries.names) == 23
