"""The object-colour solid compared with a bounded linear solver."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.optimize import brentq, lsq_linear
from scipy.spatial import ConvexHull

from uplift.colorimetry import observer
from uplift.colorimetry.object_colours import solid, toward_grey
from uplift.extras.looks.metamer_bounds import solid_volume
from uplift.lattice.lattice import Lattice, axis_nodes


def best_residual(sensor, rgb):
    """Smallest max |linear RGB| residual over all reflectances, for each
    colour (n, 3).
    """
    found = [
        lsq_linear(sensor.matrix, colour, (0, 1), method="bvls", tol=1e-14)
        for colour in rgb
    ]
    return np.array([np.abs(result.fun).max() for result in found])


@pytest.mark.parametrize("space", ["sRGB", "ProPhoto RGB"])
def test_solid_contains_the_colours_that_a_solver_reaches(space):
    """On a small lattice, and on the nodes of a large one nearest to the boundary."""
    sensor = observer.sensor(space)
    limits = solid(sensor.matrix)
    large = Lattice(axis_nodes("srgb", 17)).points
    nearest = large[np.argsort(np.abs(limits.signed_distance(large)))[:20]]
    colours = np.concatenate([Lattice(np.linspace(0, 1, 3)).points, nearest])
    assert_array_equal(limits.contains(colours), best_residual(sensor, colours) <= 1e-8)


def test_solid_volume_is_that_of_the_convex_hull(sensor):
    """For few wavelengths, all corners of the zonotope can be listed."""
    few = sensor.matrix[:, ::9]
    corners = (
        np.array(np.meshgrid(*[(0, 1)] * few.shape[1])).reshape(few.shape[1], -1).T
        @ few.T
    )
    assert solid_volume(few) == pytest.approx(ConvexHull(corners).volume)


def test_colours_move_toward_grey_until_they_are_a_margin_inside():
    """Against a root of the signed distance, and unchanged deeper inside."""
    wide = observer.sensor("ProPhoto RGB", "D65")
    limits = solid(wide.matrix)
    target = np.random.default_rng(4).uniform(0, 1, (200, 3))
    grey = wide.grey(target)
    margin = 1e-3
    moved = toward_grey(limits, grey, target, margin)
    deep = limits.signed_distance(target) < -2 * margin
    assert 20 < deep.sum() < 180
    assert_array_equal(moved[deep], target[deep])
    assert limits.contains(moved).all()
    for row in np.flatnonzero(~limits.contains(target))[:20]:
        toward = target[row] - grey[row]
        share = brentq(
            lambda share, row=row, toward=toward: limits.signed_distance(
                (grey[row] + share * toward)[None]
            )[0],
            0,
            1,
        )
        boundary = grey[row] + share * toward
        assert np.abs(moved[row] - boundary).max() == pytest.approx(margin, rel=1e-3)
