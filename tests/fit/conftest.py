"""The problem of most tests of the fit."""

import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.fit.problem import Problem
from uplift.models.moments import Moments


@pytest.fixture(scope="session")
def problem(sensor):
    """Nine moments, with errors under A."""
    lights = tuple(map(observer.light, SCENE_LIGHTS))
    return Problem(sensor, Moments(9), lights, observer.light("A"))
