"""Spectrum models in Dr.Jit agree with numpy."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.io.mitsuba.texture import blend
from uplift.models import Moments, Phase, Sigmoid, evaluate

WAVELENGTHS = [340.0, 401.5, 555.0, 820.0]
MODELS = [Moments(9), Moments(3), Moments(17, Phase(400, 700, "vision")), Sigmoid(), Sigmoid(400, 700)]


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
    linear, model = np.concatenate([-large, large]), Moments(9)
    flat = [[x, *[0.0] * 8] for x in linear.tolist()]
    found = np.array([blend(model, [each], [1.0], mi.Spectrum(500.0))[0] for each in flat])
    np.testing.assert_allclose(found, 0.5 + np.arctan(linear) / np.pi, rtol=0, atol=1e-6)
    assert found.min() >= 0
    assert found.max() <= 1
