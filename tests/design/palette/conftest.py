"""One factor model for all tests of palettes, and palettes written in a few words."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.design.palette import FactorModel, Palette, standard_model
from uplift.design.palette.lights import illuminant
from uplift.design.palette.palette import Part, Wish


@pytest.fixture(scope="session")
def model(sensor) -> FactorModel:
    """Seven coefficients."""
    return standard_model(sensor)


@pytest.fixture(scope="session")
def day(sensor) -> Part:
    return Part("day", illuminant(sensor, "D65"))


@pytest.fixture(scope="session")
def lamp(sensor) -> Part:
    return Part("lamp", illuminant(sensor, "FL11"))


@pytest.fixture(scope="session")
def metamers(sensor, day, lamp) -> Palette:
    """Two paints that share a free colour by day, and differ under the lamp."""
    return Palette(
        sensor,
        (day, lamp),
        (Part("fox", None), Part("moss", None)),
        (
            Wish("fox", "day", free="coat"),
            Wish("moss", "day", free="coat"),
            Wish("fox", "lamp", rgb=np.array([0.52, 0.22, 0.14])),
            Wish("moss", "lamp", rgb=np.array([0.30, 0.29, 0.14])),
        ),
        {"coat": (np.zeros(3), np.ones(3))},
    )
