"""Fixtures: the ColorChecker under smooth and under spiky lights."""

from __future__ import annotations

import pytest

from tests.conftest import MACBETH
from uplift import read_atlas
from uplift.atlas import on_grid
from uplift.common.arrays import Array
from uplift.scene.wavelengths import grid, make_setup
from uplift.scene.wavelengths.sampling import RenderSetup


@pytest.fixture(scope="session")
def checker() -> Array:
    """Reflectances (24, 391) of the ColorChecker at 380–770 nm."""
    return on_grid(read_atlas(MACBETH), grid())


@pytest.fixture(scope="session")
def smooth(checker: Array) -> RenderSetup:
    return make_setup(checker, ["A", "D65"])


@pytest.fixture(scope="session")
def spiky(checker: Array) -> RenderSetup:
    return make_setup(checker, ["FL2", "FL11"])
