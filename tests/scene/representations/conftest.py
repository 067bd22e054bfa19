"""Fixtures: the ColorChecker scene and every representation of it."""

from __future__ import annotations

import numpy as np
import pytest

from tests.lab.comparison_scenes import colorchecker
from uplift.lab.comparison.compare import Scene
from uplift.scene.representations import all_representations


@pytest.fixture(scope="session")
def checker() -> Scene:
    return colorchecker()


@pytest.fixture(scope="session")
def every(checker):
    """Every representation by name."""
    return {one.name: one for one in all_representations(checker.powers, checker.surfaces)}


@pytest.fixture
def light_powers(checker):
    """Function of the name of a light that returns its powers (24, 401), one row per patch."""

    def light_powers(name):
        part = next(part for part in checker.sets if name in part.lights)
        power = part.powers[part.lights.index(name)]
        return np.tile(power, (len(checker.surfaces), 1))

    return light_powers
