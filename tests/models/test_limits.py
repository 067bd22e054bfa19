"""Range, monotonicity and limits of the models, and storage at every count of moments."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.models import Moments, Phase, Sigmoid, evaluate

GRID = np.arange(380.0, 781.0, 5.0)
MODELS = [Moments(3), Moments(9), Moments(17), Moments(9, Phase(warp="vision")), Sigmoid()]
each = pytest.mark.parametrize("model", MODELS, ids=lambda model: f"{model.name}{model.count}")
wide = st.floats(-1e9, 1e9)


@each
@given(data=st.data())
def test_all_multipliers_give_reflectances(model, data):
    multipliers = data.draw(arrays(float, (3, model.count), elements=wide))
    spectra = evaluate(model, multipliers, GRID)
    assert ((spectra >= 0) & (spectra <= 1)).all()


@each
@given(x=arrays(float, 6, elements=st.floats(-1e12, 1e12)))
def test_squash_is_increasing(model, x):
    assert (np.diff(model.squash(np.sort(x))) >= -1e-16).all()
    assert (model.slope(x) >= 0).all()


@each
def test_limits_are_black_and_white(model):
    np.testing.assert_allclose(model.squash(np.array([-1e9, 1e9])), [0, 1], atol=1e-9)


@each
def test_black_and_white_have_finite_multipliers(model):
    limits = np.array([0.0, 1.0])
    np.testing.assert_allclose(model.squash(model.unsquash(limits)), limits, atol=1e-12)


@each
@given(y=arrays(float, 5, elements=st.floats(1e-6, 1 - 1e-6)))
def test_unsquash_is_the_inverse_of_squash(model, y):
    np.testing.assert_allclose(model.squash(model.unsquash(y)), y, rtol=1e-9)


@settings(max_examples=40)
@given(st.data(), st.integers(3, 17))
def test_reconstruction_has_the_given_moments_at_every_count(data, count):
    model = Moments(count)
    multipliers = data.draw(arrays(float, (4, count), elements=st.floats(-3, 3)))
    stored = model.to_storage(multipliers)
    assert ((stored[:, 0] > 0) & (stored[:, 0] < 1)).all()
    again = model.to_storage(model.from_storage(stored))
    np.testing.assert_allclose(again, stored, rtol=0, atol=1e-9)
