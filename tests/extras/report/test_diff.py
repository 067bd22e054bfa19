"""Two cubes compared: what differs, where, and the page of it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import raises, with_absent_points, with_points
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.common import machine
from uplift.common.errors import OptionError
from uplift.extras.report.diff import diff_cubes
from uplift.extras.report.diff_page import render_diff
from uplift.lookup.cube import Cube

LIGHTS = ("D65", "A")


@pytest.fixture(scope="module")
def two_scenes(plain_cube):
    """The plain cube with its darkest cell alone, and with its brightest alone."""
    data = plain_cube.data
    position = data.lattice.position(np.arange(data.lattice.size))
    darkest = (position < 2).all(axis=1)
    brightest = (position > data.lattice.dim - 3).all(axis=1)
    return [Cube(with_absent_points(data, kept)) for kept in (darkest, brightest)]


@pytest.fixture(scope="module")
def changed(small_cube):
    """The cube with one other node."""
    coefficients = small_cube.data.points.coefficients.copy()
    coefficients[210, 3] += 0.02
    return Cube(with_points(small_cube.data, coefficients=coefficients))


def test_the_node_that_changed_is_the_worst(small_cube, changed):
    rgb = small_cube.data.lattice.points[210]
    image = np.full((2, 3, 3), 0.9)
    image[0, 0] = rgb
    found = diff_cubes({"a": small_cube, "b": changed}, LIGHTS, {"image.png": image})
    assert found.nodes.worst_rows(3)[0] == 210
    assert found.images[0].worst_rows(1).tolist() == [0]
    assert found.entries.largest == 0
    nm = small_cube.data.sensor.wavelengths
    spectra = (cube.reflectance(rgb, nm) for cube in (small_cube, changed))
    expected = delta_e_spectra(light("A"), *spectra)
    assert found.nodes.delta_e[210, 1] == pytest.approx(expected)
    assert not found.is_within(0.9 * found.largest)
    assert found.is_within(found.largest)
    assert render_diff(found, {"image.png": image}, 2).count("<svg") >= 4


def test_entries_are_compared_by_name(small_cube, plain_cube):
    names = small_cube.data.atlas.with_outside.names
    found = diff_cubes({"a": small_cube, "b": plain_cube}, LIGHTS)
    assert found.pairs.removed == names
    assert not found.is_within(100)
    assert diff_cubes({"a": plain_cube, "b": small_cube}, LIGHTS).pairs.added == names
    # Renamed entries are compared with those that now have their names.
    atlas = small_cube.data.atlas
    renamed = replace(small_cube.data, atlas=replace(atlas, names=atlas.names[::-1]))
    found = diff_cubes({"a": small_cube, "b": Cube(renamed)}, LIGHTS)
    nm = small_cube.data.sensor.wavelengths
    spectra = atlas.spectra.reflectance(np.arange(len(atlas.names)), nm)
    assert_allclose(
        found.entries.delta_e[:-1, 0],  # without the one outside the space
        delta_e_spectra(light("D65"), spectra, spectra[::-1]),
    )


def test_lattices_of_other_dims_are_compared_at_the_nodes_of_both(plain_cube):
    found = diff_cubes({"a": plain_cube, "b": uplift.build(dim=3)}, LIGHTS)
    assert len(found.nodes.rgb) == 8**3 + 3**3
    assert found.largest > 0


def test_colours_that_one_cube_lacks_are_counted_and_fail(plain_cube, two_scenes):
    first, second = two_scenes
    for cubes in ({"a": first, "b": plain_cube}, {"a": plain_cube, "b": second}):
        found = diff_cubes(cubes, LIGHTS)
        (row,) = found.lacking
        assert row["cubes"] == "ab"[cubes["a"] is plain_cube]
        assert row["colours"] == np.isnan(found.nodes.worst).sum() > 0
        assert not found.is_within(100)
    assert diff_cubes({"a": first, "b": first}, LIGHTS).is_within(0)
    image = np.array([[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.0, 0.0]]])
    found = diff_cubes({"a": first, "b": second}, LIGHTS, {"image": image})
    lacking = [row["cubes"] for row in found.lacking if row["set"] == "image"]
    assert lacking == ["a", "b", "a and b"]
    assert "a and b cannot answer" in render_diff(found, {"image": image}, 2)


def test_cubes_that_cannot_be_compared_raise(plain_cube, monkeypatch):
    wide = uplift.build(dim=2, space="Display P3")
    with raises(OptionError, "cubes-of-different-spaces"):
        diff_cubes({"a": plain_cube, "b": wide}, LIGHTS)
    monkeypatch.setattr(machine, "free_memory", lambda: 10_000)
    with raises(OptionError, "out-of-memory"):
        diff_cubes({"a": plain_cube, "b": plain_cube}, LIGHTS)
