"""Fixtures: one factor model for all tests, two lights, and a small palette."""

import numpy as np
import pytest

from uplift.extras.papers.palette.colours import illuminant
from uplift.extras.papers.palette.factor import FactorModel, standard_model
from uplift.extras.papers.palette.palette import ColourGoal, Palette, SpectrumSpec


@pytest.fixture(scope="session")
def model(sensor) -> FactorModel:
    """The standard model of seven coefficients."""
    return standard_model(sensor)


@pytest.fixture(scope="session")
def metamers(sensor) -> Palette:
    """Palette of two paints that share a free colour by day and differ
    under the lamp.
    """
    return Palette(
        sensor,
        (
            SpectrumSpec("day", illuminant(sensor, "D65")),
            SpectrumSpec("lamp", illuminant(sensor, "FL11")),
        ),
        (SpectrumSpec("fox", None), SpectrumSpec("moss", None)),
        (
            ColourGoal("fox", "day", free="coat"),
            ColourGoal("moss", "day", free="coat"),
            ColourGoal("fox", "lamp", rgb=np.array([0.52, 0.22, 0.14])),
            ColourGoal("moss", "lamp", rgb=np.array([0.30, 0.29, 0.14])),
        ),
        {"coat": (np.zeros(3), np.ones(3))},
    )
