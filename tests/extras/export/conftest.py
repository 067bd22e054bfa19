"""Fixtures: a cube of unusual phase and number of moments, and one of sigmoids with an
atlas.
"""

from dataclasses import replace

import pytest

from tests.helpers import with_points
from uplift.cube.data import EntrySpectra
from uplift.lookup.cube import Cube, load
from uplift.models.moments import Moments


@pytest.fixture(scope="session")
def warped_cube(small_cube) -> Cube:
    """Cube of five of nine moments, reinterpreted with another wavelength range and
    warp.
    """
    data = small_cube.data
    model = Moments(5, 400, 700, "colour")
    coefficients = data.atlas.coefficients[:, :5]
    atlas = replace(
        data.atlas, coefficients=coefficients, spectra=EntrySpectra(model, coefficients)
    )
    return Cube(
        with_points(
            replace(data, model=model, atlas=atlas),
            coefficients=data.points.coefficients[:, :5],
        )
    )


@pytest.fixture(scope="session")
def sigmoid_cube(repository) -> Cube:
    return load(repository / "cubes" / "sigmoid-8-macbeth.uplift")
