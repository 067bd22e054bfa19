"""Bounds of answers under other lights."""

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab
from uplift.extras.looks.lab_errors import lab_errors
from uplift.extras.looks.metamer_bounds import bounds

FL11 = observer.light("FL11")


def test_the_answer_lies_inside(small_cube):
    rgb = np.random.default_rng(1).uniform(size=(40, 3))
    found = bounds(small_cube, rgb, FL11)
    assert_array_equal(found.reflectance, small_cube.reflectance(rgb))
    # Answers have their RGB to rounding.
    assert found.volumes.excess(found.xyz).max() <= 1e-6
    least, most = np.moveaxis(found.box, 1, 0)
    assert ((least <= found.lab + 1e-3) & (found.lab <= most + 1e-3)).all()
    assert ((found.share > 0) & (found.share < 1)).all()


def test_the_likely_region_is_the_ellipse_of_the_covariance(small_cube):
    found = bounds(small_cube, np.array([[0.3, 0.4, 0.2]]), FL11)
    offset = found.likely(0) - found.lab[0, 1:]
    squares = np.einsum(
        "mi,ij,mj->m", offset, np.linalg.inv(found.covariance[0, 1:, 1:]), offset
    )
    assert_allclose(squares, lab_errors(small_cube.data, FL11).likely_radius ** 2)


def test_colours_outside_the_space_are_answered(plain_cube):
    rgb = np.array([[0.5, 0.5, 0.5], [-0.05, 0.4, 0.3]])
    found = bounds(plain_cube, rgb, FL11, divisions=1)
    assert_allclose(plain_cube.data.sensor.rgb(found.reflectance), rgb, atol=1e-4)
    assert_allclose(found.lab, lab(found.reflectance @ FL11.xyz.T, FL11.white))
