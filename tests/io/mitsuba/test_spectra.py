"""Spectrum models in Dr.Jit agree with numpy."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.io.mitsuba.spectra import basis, blend, squash
from uplift.models import Moments, Phase, Sigmoid, evaluate

WAVELENGTHS = [340.0, 401.5, 555.0, 820.0]
MODELS = [Moments(9), Moments(3), Moments(17, Phase(400, 700, "vision")), Sigmoid(), Sigmoid(400, 700)]


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_basis_and_squash(mi, model):
    found = np.array([np.array(part) for part in basis(model, mi.Spectrum(*WAVELENGTHS))]).T
    np.testing.assert_allclose(found, model.basis(WAVELENGTHS), atol=3e-5)
    linear = np.array([-300, -0.5, 0.2, 20.0])
    np.testing.assert_allclose(np.array(squash(model, mi.Spectrum(*linear))), model.squash(linear), rtol=0, atol=1e-6)


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_blend_is_the_weighted_sum(mi, model):
    multipliers = np.random.default_rng(2).normal(size=(3, model.count))
    weights = [0.5, 0.2, 0.3]
    found = blend(model, multipliers.tolist(), weights, mi.Spectrum(*WAVELENGTHS))
    expected = weights @ evaluate(model, multipliers, WAVELENGTHS)
    np.testing.assert_allclose(np.array(found), expected, rtol=0, atol=1e-5)


def test_the_arc_tangent_is_a_polynomial_of_its_cosine(mi):
    """Reflectances stay in [0, 1] however large the linear part is."""
    large = np.logspace(-6, 8, 500)
    found = np.array([squash(Moments(9), mi.Float(float(x))) for x in np.concatenate([-large, large])])
    expected = 0.5 + np.arctan(np.concatenate([-large, large])) / np.pi
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)
    assert found.min() >= 0
    assert found.max() <= 1
