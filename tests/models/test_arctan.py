"""The vectorised arc tangent against the C library's, for all sizes of argument and for its derivative."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from uplift.models.arctan import arctan

SIZES = np.concatenate([[0], np.logspace(-300, 300, 4001), np.linspace(0.5, 2, 4001)])


@pytest.mark.parametrize(("dtype", "within"), [(np.float64, 6e-16), (np.float32, 4e-7)])
def test_it_is_the_arc_tangent_to_the_last_digits(dtype, within):
    x = np.concatenate([SIZES, -SIZES]).clip(np.finfo(dtype).min, np.finfo(dtype).max)
    expected = np.arctan(x)
    with jax.enable_x64(dtype is np.float64):
        found = np.asarray(arctan(jnp.asarray(x, dtype=dtype)), dtype=float)
    normal = np.abs(x) > np.finfo(dtype).tiny
    np.testing.assert_allclose(found[normal], expected[normal], rtol=within, atol=0)
    assert np.abs(found[~normal]).max() <= np.finfo(dtype).tiny


def test_it_can_be_differentiated_everywhere():
    x = np.array([-1e3, -1.0, -0.3, 0.0, 0.3, 1.0, 1e3])
    with jax.enable_x64(True):
        slope = jax.vmap(jax.grad(arctan))(jnp.asarray(x))
    np.testing.assert_allclose(slope, 1 / (1 + x * x), rtol=1e-9)


def test_infinity_and_what_is_no_number():
    with jax.enable_x64(True):
        found = np.asarray(arctan(jnp.array([np.inf, -np.inf, np.nan])))
    np.testing.assert_array_equal(found, [np.pi / 2, -np.pi / 2, np.nan])


def test_numpy_keeps_its_own():
    assert isinstance(arctan(np.zeros(3)), np.ndarray)
