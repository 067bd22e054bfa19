"""Passes for tests, chosen once."""

import pytest

from uplift.extras.scene.passes.bands import Bands
from uplift.extras.scene.passes.choice import fit_bands
from uplift.extras.scene.passes.materials import Materials, library_materials
from uplift.extras.scene.passes.passes import Passes

LIGHTS = ("D65", "A", "FL11")
SIX = Bands((448.0, 498.0, 543.0, 581.0, 610.0, 652.0), 10.0)


@pytest.fixture(scope="session")
def library() -> Materials:
    """The shipped materials in halves."""
    return library_materials()


@pytest.fixture(scope="session")
def two_passes(library: Materials) -> Passes:
    """Two passes with three lights."""
    return fit_bands(SIX, library, LIGHTS)
