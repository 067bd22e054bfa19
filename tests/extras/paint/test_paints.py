"""Measured paints: laws of mixtures and films, the same numbers by numpy and JAX."""

from dataclasses import replace

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.extras.paint.invented import OIL, WAVELENGTHS, invented
from tests.helpers import raises
from uplift.colorimetry.delta_e import lab
from uplift.common.errors import OptionError
from uplift.extras.paint.paints import strengths

PARTS = np.array([3.0, 1.0, 0.5, 2.0])
GROUND = np.linspace(0.2, 0.9, len(WAVELENGTHS))


@pytest.fixture(scope="module")
def paints():
    return invented()


@pytest.mark.parametrize("thickness", [0.3, 2.0])
def test_a_film_is_a_layer_beneath_the_surface(paints, thickness):
    layer = paints.pigments.mix(PARTS).layer(thickness)
    expected = OIL.apply(layer.over(OIL.remove(GROUND)))
    assert_allclose(paints.reflectance(PARTS, thickness, GROUND), expected)


def test_a_selection_mixes_as_the_others_left_out(paints):
    few = replace(paints, prices=(1.0, 2.0, 3.0, 4.0)).select(["blue", "white"])
    assert few.names == ("blue", "white")
    assert few.prices == (4, 1)
    expected = paints.reflectance([3, 0, 0, 1])
    assert_allclose(few.reflectance([1, 3]), expected, rtol=1e-12)


def test_interpolation_keeps_the_samples(paints):
    K = paints.pigments.absorption
    finer = paints.at(np.arange(380.0, 721, 10)).pigments.absorption
    assert_array_equal(finer[:, 2:-2:2], K)
    assert_array_equal(finer[:, 0], K[:, 0])
    assert_allclose(finer[:, 3], K[:, :2].mean(axis=1))


def test_costs_are_means_of_prices(paints):
    priced = replace(paints, prices=(1.0, 2.0, np.nan, 4.0))
    assert_allclose(priced.cost([[1, 0, 0, 0], [1, 3, 0, 0]]), [1, 1.75])
    assert np.isnan(priced.cost([1, 0, 1, 0]))


@pytest.mark.parametrize("paint", [1, 2, 3])
def test_strength_is_the_white_that_balances_absorption(paints, paint):
    parts = np.zeros(4)
    parts[[0, paint]] = strengths(paints, 0)[paint], 1
    mixed = paints.pigments.mix(parts)
    strongest = paints.pigments.absorption[paint].argmax()
    expected = mixed.scattering[strongest]
    assert mixed.absorption[strongest] == pytest.approx(expected)


@pytest.mark.parametrize("parts", [[0, 0, 0, 0], [1, 1, 1], [1, -1, 0, 0], 1.0])
def test_invalid_parts_raise(paints, parts):
    with raises(OptionError):
        paints.reflectance(parts)


@pytest.mark.parametrize("level", [0.0, 1e-300, (6 / 29) ** 3])
def test_gradients_are_finite_at_black(level):
    """Where a cube root alone has none."""
    with jax.enable_x64(True):
        slopes = jax.jacfwd(lambda xyz: lab(xyz, np.ones(3)))(np.full(3, level))
        assert np.isfinite(slopes).all()
