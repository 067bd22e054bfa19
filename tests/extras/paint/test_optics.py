"""Layers agree with the sum over interreflections, surfaces with the integral of
Fresnel's equations.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.extras.paint import optics
from uplift.extras.paint.optics import Layer, Surface, add_lights, average_areas

INDICES = (1.01, 1.2, 1.5, 1.66, 2.4)


def test_lights_add_up_and_areas_are_averaged(spectra, parts):
    expected = sum(parts[:, i, None] * spectra[:, i] for i in range(3))
    assert_allclose(add_lights(spectra, parts), expected)
    for scale in (1, 7):
        mean = expected / parts.sum(axis=1, keepdims=True)
        assert_allclose(average_areas(spectra, scale * parts), mean)


def test_reflectance_on_a_ground_is_the_sum_of_all_reflections():
    layer = Layer(np.array([0.2, 0.5, 0.0]), np.array([0.7, 0.1, 1.0]))
    ground = np.array([0.9, 1.0, 0.5])
    passes = (
        layer.transmittance**2 * ground * (layer.reflectance * ground) ** bounce
        for bounce in range(2000)
    )
    assert_allclose(layer.over(ground), layer.reflectance + sum(passes))
    assert Layer(np.ones(1), np.zeros(1)).over(1.0) == 1, (
        "mirrors face to face give no NaN"
    )


def integrated(n):
    """Integrate Fresnel's reflectance of unpolarised light over the hemisphere by the
    midpoint rule.
    """
    cosine = (np.arange(200_000) + 0.5) / 200_000
    inner = np.sqrt(1 - (1 - cosine**2) / n**2)
    s = (cosine - n * inner) / (cosine + n * inner)
    p = (n * cosine - inner) / (n * cosine + inner)
    return float(((s**2 + p**2) / 2 * 2 * cosine).mean())


@pytest.mark.parametrize("n", INDICES)
def test_duntley_s_formula_is_the_integral_of_fresnel_s(n):
    assert optics.diffuse_reflectance(n) == pytest.approx(integrated(n), abs=1e-8)


def test_published_values():
    """The thesis for an index of 1.5: 4 % (9.3) and 9 % (10.3); Judd 1942: 0.596 from
    within.
    """
    assert optics.fresnel_reflectance(1.5) == pytest.approx(0.04)
    assert optics.diffuse_reflectance(1.5) == pytest.approx(0.0918, abs=5e-5)
    assert optics.internal_reflectance(1.5) == pytest.approx(0.596, abs=5e-4)


@pytest.mark.parametrize("n", INDICES)
def test_saunderson_round_trip(n):
    surface = Surface.of_index(n)
    internal = np.linspace(0, 1, 101)
    measured = surface.apply(internal)
    assert_allclose(surface.remove(measured), internal, atol=1e-12)
    assert (np.diff(measured) > 0).all()
    assert measured[0] == surface.outside
    assert measured[-1] == pytest.approx(
        1
    )  # perfect white stays white, as nothing absorbs


@pytest.mark.parametrize(
    ("make", "values"),
    [(Surface.of_index, (index,)) for index in (0.9, np.nan, np.inf)]
    + [(Surface, each) for each in ((1, 0), (0, 1), (-0.1, 0), (np.nan, 0))],
)
def test_invalid_surfaces_raise(make, values):
    with raises(OptionError):
        make(*values)
