"""Surfaces agree with the integral of Fresnel's equations and with published values."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.design.mixing import surface

INDICES = (1.01, 1.2, 1.5, 1.66, 2.4)


def integrated(n):
    """Integrate Fresnel's reflectance of unpolarised light over the hemisphere by the midpoint rule."""
    cosine = (np.arange(200_000) + 0.5) / 200_000
    inner = np.sqrt(1 - (1 - cosine**2) / n**2)
    s = (cosine - n * inner) / (cosine + n * inner)
    p = (n * cosine - inner) / (n * cosine + inner)
    return float(((s**2 + p**2) / 2 * 2 * cosine).mean())


@pytest.mark.parametrize("n", INDICES)
def test_duntley_s_formula_is_the_integral_of_fresnel_s(n):
    assert surface.diffuse_reflectance(n) == pytest.approx(integrated(n), abs=1e-8)


def test_the_formula_as_printed_is_wrong():
    n = 1.5
    printed = surface.diffuse_reflectance(n) + (n - 1) * (3 * n + 1) * (1 / (8 * n + 1) - 1 / (6 * (n + 1) ** 2))
    assert printed != pytest.approx(integrated(n), abs=0.1)


def test_published_values():
    """The thesis for an index of 1.5: 4 % (9.3) and 9 % (10.3); Judd 1942: 0.596 from within."""
    assert surface.fresnel_reflectance(1.5) == pytest.approx(0.04)
    assert surface.diffuse_reflectance(1.5) == pytest.approx(0.0918, abs=5e-5)
    assert surface.internal_reflectance(1.5) == pytest.approx(0.596, abs=5e-4)


def test_an_index_of_1_has_no_surface():
    assert surface.normal_incidence(1) == surface.diffuse_incidence(1) == surface.NO_SURFACE


@pytest.mark.parametrize("of", [surface.normal_incidence, surface.diffuse_incidence])
@pytest.mark.parametrize("n", INDICES)
def test_saunderson_round_trip(of, n):
    internal = np.linspace(0, 1, 101)
    measured = of(n).apply(internal)
    np.testing.assert_allclose(of(n).remove(measured), internal, atol=1e-12)
    assert (np.diff(measured) > 0).all()
    assert measured[0] == of(n).outside
    assert measured[-1] == pytest.approx(1)  # perfect white stays white, as nothing absorbs


def test_no_surface_changes_nothing():
    np.testing.assert_array_equal(surface.NO_SURFACE.apply([0, 0.3, 1]), [0, 0.3, 1])


def test_reflectance_below_the_surface_s_is_negative_beneath():
    assert surface.normal_incidence(1.5).remove(0.03) < 0


@pytest.mark.parametrize("n", [0.9, np.nan, np.inf])
def test_an_index_below_1_raises(n):
    for of in (surface.fresnel_reflectance, surface.diffuse_reflectance, surface.internal_reflectance):
        with raises(OptionError, "invalid-refractive-index"):
            of(n)


@pytest.mark.parametrize("values", [(1, 0), (0, 1), (-0.1, 0), (np.nan, 0)])
def test_invalid_reflectances_of_a_surface_raise(values):
    with raises(OptionError, "invalid-surface"):
        surface.Surface(*values)
