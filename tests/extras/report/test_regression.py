"""Comparison of a stored cube with a rebuilt one: what passes, and that all
else fails.
"""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import uplift
from tests.helpers import raises, with_points
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.common.errors import CubeFileError
from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
from uplift.extras.report.regression import (
    LIMITS,
    RebuildDifference,
    compare_rebuilt,
)
from uplift.lattice.lattice import Lattice
from uplift.lattice.point_table import Status
from uplift.models.model import evaluate

PATH = Path("cube.uplift")
GRID = np.arange(380.0, 781.0, 5.0)


@pytest.fixture
def data(small_cube):
    return small_cube.data


def with_point(data, name, point, value):
    array = getattr(data.points, name).copy()
    array[point] = value
    return with_points(data, **{name: array})


def test_a_rounding_error_passes_and_a_changed_colour_or_status_fails(data):
    point = (300, 4)
    coefficient = data.points.coefficients[point] * (1 + 1e-14)
    rgb = data.points.rgb[300, 1] + 2 * LIMITS["rgb"]
    for name, at, value, failures in (
        ("coefficients", point, coefficient, []),
        ("rgb", (300, 1), rgb, ["rgb"]),
        ("status", 300, Status.UNFITTED, ["status"]),
    ):
        found = compare_rebuilt(PATH, data, with_point(data, name, at, value))
        assert found.failures == failures
    counts = [found.status[each]["unfitted"] for each in ("stored", "rebuilt")]
    assert counts[1] == counts[0] + 1


@pytest.mark.parametrize("name", LIMITS)
def test_measures_fail_above_their_limits_and_as_nan(name):
    measures = dict.fromkeys(LIMITS, 0.0)
    for value, failures in [
        (LIMITS[name], []),
        (LIMITS[name] * 1.001, [name]),
        (float("nan"), [name]),
        (float("inf"), [name]),
    ]:
        assert RebuildDifference(measures | {name: value}).failures == failures


def with_atlas(data, **changes):
    return dataclasses.replace(data, atlas=dataclasses.replace(data.atlas, **changes))


def test_entries_are_compared_by_name(data):
    names = data.atlas.names
    found = compare_rebuilt(PATH, data, with_atlas(data, names=("new", *names[1:])))
    assert [(entry.name, entry.change) for entry in found.entries] == [
        (names[0], "removed"),
        ("new", "added"),
    ]
    assert found.failures == ["entries"]
    assert max(found.measures.values()) == 0
    reordered = compare_rebuilt(PATH, data, with_atlas(data, names=names[::-1]))
    assert {entry.change for entry in reordered.entries} == {"moved"}
    assert max(entry.delta_e for entry in reordered.entries) > 1


def test_measures_are_the_largest_and_the_rms(plain_cube):
    data = plain_cube.data
    model = data.model
    other = with_points(data, coefficients=data.points.coefficients[::-1].copy())
    first, second = (
        evaluate(model, model.from_storage(each.points.coefficients), GRID)
        for each in (data, other)
    )
    measures = compare_rebuilt(PATH, data, other).measures
    largest = np.abs(first - second).max()
    assert measures["spectra_max"] == pytest.approx(largest, rel=1e-12)
    rms = np.sqrt(np.mean((first - second) ** 2))
    assert measures["spectra_rms"] == pytest.approx(rms, rel=1e-12)
    for name in REGRESSION_LIGHTS:
        expected = delta_e_spectra(light(name), first, second).max()
        assert measures[f"delta_e_{name}"] == pytest.approx(expected, rel=1e-9)


def test_nodes_may_differ_by_rounding_only(data):
    nodes = data.lattice.nodes
    inner = np.arange(8) == 3
    rounded = dataclasses.replace(data, lattice=Lattice(nodes + 1e-15 * inner))
    assert not np.array_equal(rounded.lattice.nodes, nodes)
    assert compare_rebuilt(PATH, data, rounded).failures == []
    for others in (nodes + 1e-11 * inner, np.linspace(0, 1, 8), np.linspace(0, 1, 5)):
        other = dataclasses.replace(data, lattice=Lattice(others))
        with raises(CubeFileError, "cube-file"):
            compare_rebuilt(PATH, data, other)


def test_entries_outside_the_space_are_compared(cyan_cube):
    data = cyan_cube.data
    outside = data.atlas.outside
    spectra = outside.spectra
    darker = dataclasses.replace(spectra, coefficients=0.99 * spectra.coefficients)
    for changes, expected in (
        ({}, []),
        ({"spectra": darker}, ["cyan"]),
        ({"names": ("turquoise",)}, ["cyan", "turquoise"]),
    ):
        changed = with_atlas(data, outside=dataclasses.replace(outside, **changes))
        left_out = {"left_out": list(changed.atlas.outside.names)}
        changed = dataclasses.replace(changed, provenance=left_out)
        found = compare_rebuilt(PATH, data, changed)
        assert [change.name for change in found.entries] == expected


def test_a_lattice_without_a_point_inside_the_realisable_colours_equals_itself():
    data = uplift.build(dim=2, coefficients=3, space="ACEScg").data
    assert Status.UNREALISABLE in data.points.status
    assert compare_rebuilt(PATH, data, data).failures == []
