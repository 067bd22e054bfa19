"""Assessed cubes, shared by the session."""

import dataclasses

import numpy as np
import pytest

import uplift
from tests.cube.hand_made import table
from tests.helpers import with_points
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.sources import read_atlas
from uplift.extras.report.assessment import assess
from uplift.lattice.point_table import Status
from uplift.lookup.cube import Cube

HOSTILE = "<script>alert('&')</script>"


@pytest.fixture(scope="session")
def macbeth(repository):
    """The ColorChecker's measured spectra."""
    return read_atlas(repository / "atlases" / "macbeth.txt")


@pytest.fixture(scope="session")
def judged(small_cube, macbeth):
    """Assessment of the stored ColorChecker cube of dim 8 by its own entries."""
    return assess(small_cube, "small.uplift", 58624, macbeth, ("D65", "A", "FL11"))


@pytest.fixture(scope="session")
def crowded_cube(macbeth):
    """Cube of the ColorChecker on a lattice too small for it."""
    with pytest.warns(uplift.UpliftWarning):
        return uplift.build(macbeth, dim=4, coefficients=5)


@pytest.fixture(scope="session")
def lossy_cube(small_cube):
    """Cube of two entries of one colour: no colour returns the second."""
    data = small_cube.data
    atlas = small_cube.data.atlas
    pair = table(
        ("grey", "über"),
        atlas.rgb[[0, 0]],
        data.model,
        atlas.coefficients[:2],
        np.array([0.5, 0.0]),
    )
    return Cube(dataclasses.replace(data, atlas=pair))


@pytest.fixture(scope="session")
def spoilt(small_cube):
    """The same cube with two nodes over the threshold."""
    distance = small_cube.data.points.distance.copy()
    status = small_cube.data.points.status.copy()
    distance[[100, 300]] = 0.01, 0.02
    status[[100, 300]] = Status.UNFITTED
    return Cube(with_points(small_cube.data, distance=distance, status=status))


@pytest.fixture(scope="session")
def hostile():
    """An atlas whose names are HTML, two entries, one of them outside sRGB."""
    at = np.arange(380.0, 781.0, 5.0)
    laser = np.where(abs(at - 520) < 12, 1.0, 0.0)
    return Atlas(
        (Entry(HOSTILE, at, np.full(81, 0.4)), Entry("laser" + HOSTILE, at, laser))
    )
