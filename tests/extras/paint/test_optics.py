"""Surfaces have the published reflectances."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.extras.paint import optics
from uplift.extras.paint.optics import Surface, add_lights, average_areas


def test_lights_add_up_and_areas_are_averaged(spectra, parts):
    expected = sum(parts[:, i, None] * spectra[:, i] for i in range(3))
    assert_allclose(add_lights(spectra, parts), expected)
    for scale in (1, 7):
        mean = expected / parts.sum(axis=1, keepdims=True)
        assert_allclose(average_areas(spectra, scale * parts), mean)


def test_published_values():
    """The thesis for an index of 1.5: 4 % (9.3) and 9 % (10.3); Judd 1942: 0.596 from
    within.
    """
    assert optics.fresnel_reflectance(1.5) == pytest.approx(0.04)
    assert optics.diffuse_reflectance(1.5) == pytest.approx(0.0918, abs=5e-5)
    assert optics.internal_reflectance(1.5) == pytest.approx(0.596, abs=5e-4)


@pytest.mark.parametrize("n", [1.01, 1.5, 2.4])
def test_saunderson_round_trip(n):
    surface = Surface.of_index(n)
    internal = np.linspace(0, 1, 101)
    measured = surface.apply(internal)
    assert_allclose(surface.remove(measured), internal, atol=1e-12)
    assert (np.diff(measured) > 0).all()
    assert measured[0] == surface.outside
    # Perfect white stays white, as nothing absorbs.
    assert measured[-1] == pytest.approx(1)


@pytest.mark.parametrize("values", [(1, 0), (0, 1), (-0.1, 0), (np.nan, 0)])
def test_invalid_surfaces_raise(values):
    with raises(OptionError):
        Surface(*values)
