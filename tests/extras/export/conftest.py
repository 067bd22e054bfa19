"""Fixtures: a cube of unusual phase and number of moments, one of sigmoids with an
atlas, and cubes with unrealisable nodes.
"""

from dataclasses import replace

import numpy as np
import pytest

import uplift
from tests.helpers import quiet_build, with_points
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


@pytest.fixture(scope="session")
def wide() -> dict[str, Cube]:
    """Cubes with unrealisable nodes, by model."""
    paint = uplift.Entry("paint", np.array([380.0, 780.0]), np.array([0.1, 0.6]))
    return {
        model: quiet_build(
            uplift.Atlas((paint,)),
            dim=4,
            space="ITU-R BT.2020",
            model=model,
            prior="smooth",
        )
        for model in ("moments", "sigmoid")
    }
