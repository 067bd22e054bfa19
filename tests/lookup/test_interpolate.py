"""The four modes of interpolation: exact at nodes, near the colour elsewhere,
continuous between cells.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.lookup.interpolate import refined_multipliers
from uplift.lookup.refine import TOLERANCE
from uplift.models.model import reflectance


def random_colours(count):
    return np.random.default_rng(3).random((count, 3))


def stored_spectra(data, wavelengths):
    """(n, N) spectra of all nodes."""
    return reflectance(data.model, data.points.coefficients, wavelengths)


@pytest.fixture(params=["plain_cube", "small_sigmoid_cube"])
def cube(request):
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("mode", ["spectra", "moments", "nearest"])
def test_a_point_has_its_stored_spectrum(cube, mode):
    at = [380.0, 500.0, 612.3, 780.0]
    found = cube.reflectance(cube.data.lattice.points, at, mode)
    assert_allclose(found, stored_spectra(cube.data, np.array(at)), rtol=0, atol=1e-12)


def test_coefficients_are_those_stored_at_a_point_and_linear_in_a_tetrahedron(cube):
    nodes = cube.data.lattice.nodes
    stored = cube.data.points.coefficients
    assert_allclose(
        cube.coefficients(cube.data.lattice.points), stored, rtol=1e-15, atol=1e-15
    )
    low = nodes[[3, 5, 2]]
    high = nodes[[4, 6, 3]]
    fraction = np.array([0.25, 0.5, 0.9])
    # blue is the furthest along its axis, then green
    path = np.array([[3, 5, 2], [3, 5, 3], [3, 6, 3], [4, 6, 3]])
    expected = [0.1, 0.4, 0.25, 0.25] @ stored[path @ [64, 8, 1]]
    found = cube.coefficients(low + fraction * (high - low))
    assert_allclose(found, expected, rtol=1e-6, atol=1e-6)


def test_refined_spectra_and_multipliers_have_the_colour(small_cube):
    rgb = random_colours(200)
    data = small_cube.data
    found = data.sensor.rgb(small_cube.reflectance(rgb, mode="refined"))
    assert_allclose(found, rgb, rtol=0, atol=2 * TOLERANCE)
    spectra = data.model.to_reflectance(
        refined_multipliers(data, rgb) @ data.model.basis(data.sensor.wavelengths).T
    )
    assert_allclose(data.sensor.rgb(spectra), rgb, rtol=0, atol=2 * TOLERANCE)


@pytest.mark.parametrize("mode", ["spectra", "moments", "refined"])
def test_answers_are_continuous_across_the_faces_of_cells(small_cube, mode):
    nodes = small_cube.data.lattice.nodes
    on = np.array([[nodes[3], 0.4, 0.2], [0.3, nodes[5], 0.7], [0.1, 0.6, nodes[1]]])
    before, after = (
        small_cube.reflectance(np.where(on == nodes[[3, 5, 1]], on + by, on), mode=mode)
        for by in (-1e-9, 1e-9)
    )
    assert_allclose(before, after, rtol=0, atol=1e-4)


def test_the_nearest_lattice_point_answers_where_no_entry_is_near(plain_cube):
    rgb = random_colours(200)
    nodes = plain_cube.data.lattice.nodes
    points = plain_cube.data.lattice.points
    low, fraction = plain_cube.data.lattice.cell(rgb)
    # Of 1, t₁, t₂, t₃, 0 the two that are furthest apart, along the axes in this order
    order = np.argsort(-fraction, axis=1)
    falling = np.take_along_axis(fraction, order, axis=1)
    best = (-np.diff(falling, prepend=1, append=0, axis=1)).argmax(axis=1)
    passed = np.argsort(order, axis=1) < best[:, None]
    wanted = nodes[low + passed]
    rows = [int(np.flatnonzero((points == point).all(axis=1))[0]) for point in wanted]
    expected = stored_spectra(plain_cube.data, plain_cube.data.sensor.wavelengths)[rows]
    assert_allclose(
        plain_cube.reflectance(rgb, mode="nearest"), expected, rtol=0, atol=1e-12
    )


def test_nearest_is_the_entry_or_the_point_of_larger_weight(small_cube):
    data = small_cube.data
    own = reflectance(
        data.atlas.spectra.model,
        data.atlas.spectra.coefficients,
        data.sensor.wavelengths,
    )
    _, high = data.entry_boxes.faces
    near, far = (
        data.atlas.rgb + share * (high - data.atlas.rgb) for share in (0.1, 0.95)
    )
    assert_allclose(
        small_cube.reflectance(near, mode="nearest"), own, rtol=0, atol=1e-12
    )
    apart = np.abs(small_cube.reflectance(far, mode="nearest") - own).max(axis=1)
    assert (apart > 1e-3).mean() > 0.7
