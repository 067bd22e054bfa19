"""The ColorChecker under smooth and under spiky lights."""

import pytest

from tests.conftest import MACBETH
from uplift import read_atlas
from uplift.atlas.resampling import on_grid
from uplift.extras.papers.wavelengths.sampling import grid, make_setup


@pytest.fixture(scope="session")
def checker():
    """Reflectances (24, 391) of the ColorChecker at 380–770 nm."""
    return on_grid(read_atlas(MACBETH), grid())


@pytest.fixture(scope="session")
def smooth(checker):
    return make_setup(checker, ["A", "D65"])


@pytest.fixture(scope="session")
def spiky(checker):
    return make_setup(checker, ["FL2", "FL11"])
