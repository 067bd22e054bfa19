"""Multipliers of real moments, compared with those of complex moments."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.models import complex_moments, duality, real_moments


@pytest.mark.parametrize("count", [3, 9, 17])
@given(values=arrays(float, (5, 17), elements=st.floats(-3, 3)))
def test_real_and_complex_arithmetic_agree(count, values):
    moments = duality.moments_from_multipliers(values[:, :count])
    found, valid = real_moments.dual(moments)
    expected, valid_on_circle = complex_moments.dual(moments.astype(complex))
    assert valid.all()
    assert valid_on_circle.all()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * (1 + np.abs(expected).max()))


def test_dark_and_light_spectra():
    """Zeroth moments near 0 and 1, where the tangent is nearly 0 or nearly infinite."""
    level = np.array([1e-4, 1e-2, 1 - 1e-2, 1 - 1e-4])
    ripple = 0.3 * level * (1 - level)
    moments = np.stack([level, ripple, ripple / 3, -ripple / 5], axis=1)
    multipliers, valid = real_moments.dual(moments)
    assert valid.all()
    np.testing.assert_allclose(duality.moments_from_multipliers(multipliers), moments, atol=1e-12)


def test_moments_outside_the_moment_space_are_invalid():
    moments = np.array([[0.5, 0.1, 0.0], [0.5, 0.4, 0.0], [1.5, 0.1, 0.0], [np.nan, 0, 0], [0.0, 0.1, 0.0]])
    assert real_moments.dual(moments)[1].tolist() == [True, False, False, False, False]


def test_spectra_are_independent():
    moments = duality.moments_from_multipliers(np.random.default_rng(4).normal(size=(9, 9)))
    alone = np.concatenate([real_moments.dual(row[None])[0] for row in moments])
    np.testing.assert_allclose(alone, real_moments.dual(moments)[0], rtol=1e-12)
