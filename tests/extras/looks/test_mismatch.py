"""Extreme reflectances, mismatch volumes and largest differences: laws, measured
metamers and linear programs.
"""

import numpy as np
import pytest
from matplotlib.path import Path
from numpy.testing import assert_allclose
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import ColourError
from uplift.extras.looks.extreme_spectra import extreme_spectra
from uplift.extras.looks.mesh import outline, sphere
from uplift.extras.looks.mismatch import largest_difference, mismatch_volumes
from uplift.extras.photographs.photograph import photograph

ROUNDING = 1e-9


def problems(matrix, name, count):
    """Numbers of random smooth reflectances by a matrix (K, 81), and responses in
    random directions of XYZ under a light.
    """
    rng = np.random.default_rng(7)
    smooth = np.cumsum(rng.normal(scale=0.3, size=(count, matrix.shape[1])), axis=1)
    values = 1 / (1 + np.exp(-smooth)) @ matrix.T
    return values, rng.normal(size=(count, 3)) @ observer.light(name).xyz


def linear_program(matrix, values, response):
    return linprog(-response, A_eq=matrix, b_eq=values, bounds=(0, 1), method="highs")


@pytest.mark.parametrize("second", [None, "A", "D50"])
@pytest.mark.parametrize("name", ["FL11", "D65"])
def test_extremes_are_those_of_a_linear_program(sensor, name, second):
    """They have the colours, and as many values other than 0 and 1 as numbers."""
    matrix = sensor.matrix
    if second is not None:
        matrix = np.concatenate([matrix, photograph(sensor, second).matrix])
    values, response = problems(matrix, name, 8)
    found = extreme_spectra(matrix, values, response)
    assert found.solved.all()
    assert_allclose(found.reflectance @ matrix.T, values, atol=1e-8)
    assert ((found.reflectance >= 0) & (found.reflectance <= 1)).all()
    between = (found.reflectance > 0) & (found.reflectance < 1)
    assert (between.sum(axis=1) <= len(matrix)).all()
    best = -np.array(
        [linear_program(matrix, values[row], response[row]).fun for row in range(8)]
    )
    assert_allclose((response * found.reflectance).sum(axis=1), best, atol=1e-8)


def test_colours_without_reflectance_are_not_solved(sensor):
    rgb = np.array([[0.5, 0.5, 0.5], [1.5, 0, 0], [-0.4, 1, -0.4]])
    response = np.tile(observer.light("A").xyz[1], (3, 1))
    found = extreme_spectra(sensor.matrix, rgb, response)
    assert found.solved.tolist() == [True, False, False]
    for bad in (rgb[:2], np.array([[0.2, 0.2, np.nan]])):
        with raises(ColourError, "colour-unrealisable"):
            mismatch_volumes(sensor, observer.light("A"), bad)


def test_the_outline_of_a_mesh_is_that_of_its_projection():
    found = sphere(3)
    skew = found.directions[:, :2] * [2.0, 1.0] + 0.2 * found.directions[:, 2:]
    moved = skew + np.array([3.0, -2.0])
    limits = outline(moved, found.faces, angles=360)
    centre = moved.mean(axis=0)
    assert Path(centre + 1.01 * (limits - centre)).contains_points(moved).all()
    assert not Path(centre + 0.95 * (limits - centre)).contains_points(moved).all()


def test_the_volume_is_that_of_the_hull_of_linear_programs(sensor):
    """Directions, solver and volume are independent of the module."""
    light = observer.light("FL11")
    rgb = np.array([0.2, 0.4, 0.1])
    directions = np.random.default_rng(3).normal(size=(250, 3))
    extremes = [linear_program(sensor.matrix, rgb, d @ light.xyz).x for d in directions]
    hull = ConvexHull(extremes @ light.xyz.T)
    volumes = mismatch_volumes(sensor, light, rgb[None], divisions=3)
    assert volumes.volume[0] == pytest.approx(hull.volume, rel=0.06)
    slack = hull.equations[:, :3] @ volumes.xyz[0].T + hull.equations[:, 3:]
    assert slack.max() < 0.1 * np.cbrt(hull.volume)
    # The planes of the boundary points bound the points of the other solver, and so do
    # the corners.
    outer = ConvexHull(volumes.corners[0])
    slack = outer.equations[:, :3] @ hull.points.T + outer.equations[:, 3:]
    assert slack.max() < ROUNDING
    assert volumes.volume[0] < outer.volume < 2 * hull.volume


@pytest.mark.parametrize("name", ["A", "FL11"])
def test_no_metamer_differs_more(plain_cube, name):
    """Against extremes in random directions, and mixtures of pairs of them."""
    light = observer.light(name)
    sensor = plain_cube.data.sensor
    rng = np.random.default_rng(6)
    rgb = rng.uniform(0.05, 0.95, size=(3, 3))
    answers = plain_cube.reflectance(rgb) @ light.xyz.T
    volumes = mismatch_volumes(sensor, light, rgb, divisions=3)
    found = largest_difference(volumes, answers)
    assert (found.outer >= found.delta_e_2000).all()
    assert volumes.excess(found.xyz).max() <= ROUNDING
    reference = lab(answers, light.white)
    largest = delta_e_2000(lab(found.xyz, light.white), reference)
    assert_allclose(found.delta_e_2000, largest)
    for row, each in enumerate(rgb):
        colours = np.tile(each, (300, 1))
        response = rng.normal(size=(300, 3)) @ light.xyz
        spectra = extreme_spectra(sensor.matrix, colours, response).reflectance
        share = rng.uniform(size=(300, 1))
        mixed = share * spectra + (1 - share) * spectra[::-1]
        metamers = np.concatenate([spectra, mixed]) @ light.xyz.T
        apart = delta_e_2000(lab(metamers, light.white), reference[row]).max()
        assert 0.8 * largest[row] < apart <= largest[row] + 0.05
