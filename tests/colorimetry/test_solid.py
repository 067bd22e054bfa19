"""The object-colour solid against a bounded linear solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from uplift.colorimetry import observer
from uplift.colorimetry.solid import solid
from uplift.lattice import Lattice

SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")


def missed(sensor, rgb):
    """max |linear RGB| by which the best of all reflectances misses each colour (n, 3)."""
    found = [lsq_linear(sensor.matrix, colour, (0, 1), method="bvls", tol=1e-14) for colour in rgb]
    return np.array([np.abs(result.fun).max() for result in found])


@pytest.mark.parametrize("space", SPACES)
def test_it_holds_what_a_solver_finds_a_reflectance_for(space):
    """On a whole small lattice, and on those points of a large one that are nearest to the boundary."""
    sensor = observer.sensor(space)
    limits = solid(sensor.matrix)
    large = Lattice(observer.axis_nodes("srgb", 17)).points
    nearest = large[np.argsort(np.abs(limits.outside(large)))[:20]]
    colours = np.concatenate([Lattice(np.linspace(0, 1, 5)).points, nearest])
    np.testing.assert_array_equal(limits.holds(colours), missed(sensor, colours) <= 1e-8)


def test_srgb_holds_nothing_else(sensor):
    assert solid(sensor.matrix).holds(Lattice(np.linspace(0, 1, 9)).points).all()


def test_spectra_of_two_steps_lie_on_the_boundary(sensor):
    """MacAdam 1935: the purest colours have a reflectance of 0 or 1 with two steps at the most.

    Nearly: the spectrum locus has dents at its ends, where the eye sees next to nothing.
    """
    limits = solid(sensor.matrix)
    rng = np.random.default_rng(1)
    for first, last in np.sort(rng.integers(0, 82, (40, 2)), axis=1):
        box = np.zeros(81)
        box[first:last] = 1
        for spectrum in (box, 1 - box):
            outside = limits.outside((sensor.matrix @ spectrum)[None])[0]
            assert -1e-5 < outside < 1e-12


def test_reach_ends_on_the_boundary():
    wide = observer.sensor("ProPhoto RGB")
    limits = solid(wide.matrix)
    target = np.array([[0.0, 1, 0], [0, 0, 1], [0.5, 0.5, 0.5]])
    origin = np.full((3, 3), 0.4)
    share = limits.reach(origin, target)
    assert share[2] == 1
    assert (share[:2] < 1).all()
    ends = origin + share[:, None] * (target - origin)
    np.testing.assert_allclose(limits.outside(ends)[:2], 0, atol=1e-12)


def test_no_colours_are_no_colours(sensor):
    assert solid(sensor.matrix).holds(np.zeros((0, 3))).shape == (0,)
