"""Cubes with unrealisable nodes, and 64-bit types of JAX."""

import jax
import numpy as np
import pytest

import uplift


@pytest.fixture(scope="session")
def wide_cube():
    """A coarse cube of ITU-R BT.2020: each cell has an unrealisable corner, and one an
    entry.
    """
    paint = uplift.Entry("paint", np.array([380.0, 780.0]), np.array([0.2, 0.5]))
    return uplift.build(uplift.Atlas((paint,)), dim=3, space="ITU-R BT.2020")


@pytest.fixture(scope="session")
def wide_sigmoid_cube():
    return uplift.build(dim=3, space="ITU-R BT.2020", model="sigmoid")


@pytest.fixture
def doubles():
    with jax.enable_x64(True):
        yield
