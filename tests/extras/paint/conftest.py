"""Fixtures: random spectra, pigments and colours; fits of invented paints."""

import numpy as np
import pytest

from tests.extras.paint.invented import FILMS, NAMES, invented, measured, plan
from uplift.extras.paint.paint_fit import fit_paints
from uplift.extras.paint.pigments import Pigment


@pytest.fixture
def rng():
    return np.random.default_rng(10)


@pytest.fixture
def spectra(rng):
    """Spectra (4, 3, 7): three for each of four mixtures, with values of 0 and 1."""
    found = rng.random((4, 3, 7))
    found[0, 0, :2] = 0, 1
    return found


@pytest.fixture
def parts(rng):
    """Parts (4, 3)."""
    return rng.random((4, 3))


@pytest.fixture
def paint(rng):
    """Pigments with K and S over five decades, including zeros."""
    K, S = 10 ** rng.uniform(-4, 1, (2, 60))
    K[:2] = 0
    S[1:3] = 0
    return Pigment(K, S)


@pytest.fixture(scope="session")
def three_paints():
    """White, yellow and red, with known K and S."""
    return invented(names=NAMES[:3])


@pytest.fixture(scope="session")
def fitted(three_paints):
    """A fit of three paints to samples with noise, of which some are films."""
    return fit_paints(measured(three_paints, plan(three_paints), 1.0, FILMS))


@pytest.fixture(scope="session")
def opaque_fit(three_paints):
    """A fit of three paints to exact samples that hide their ground."""
    return fit_paints(measured(three_paints, plan(three_paints)))
