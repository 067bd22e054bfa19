"""One factor model for all tests of palettes."""

from __future__ import annotations

import pytest

from uplift.palette import FactorModel, standard_model


@pytest.fixture(scope="session")
def model(sensor) -> FactorModel:
    """Seven coefficients."""
    return standard_model(sensor)
