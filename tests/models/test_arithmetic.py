"""The vectorised arc tangent compared with the C library, for all magnitudes; sliced
matrix products.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.models.arithmetic import (
    SINGLE_THREAD_SIZE,
    arctan,
    arctan_difference,
    blocked_matmul,
    blocked_matmul_columns,
)

SIZES = np.concatenate([[0], np.logspace(-300, 300, 801), np.linspace(0.5, 2, 801)])


@pytest.mark.parametrize(("dtype", "within"), [(np.float64, 6e-16), (np.float32, 4e-7)])
def test_polynomial_is_accurate_to_the_last_digits(dtype, within):
    x = np.concatenate([SIZES, -SIZES]).clip(np.finfo(dtype).min, np.finfo(dtype).max)
    expected = np.arctan(x)
    with jax.enable_x64(dtype is np.float64):
        found = np.asarray(arctan(jnp.asarray(x, dtype=dtype)), dtype=float)
    normal = np.abs(x) > np.finfo(dtype).tiny
    assert_allclose(found[normal], expected[normal], rtol=within, atol=0)
    assert np.abs(found[~normal]).max() <= np.finfo(dtype).tiny


@pytest.mark.parametrize("change", [0.0, 1e-9, 1e-3, 0.06, 0.3, 5.0, 1e4, 1e8])
def test_difference_of_arc_tangents(change):
    x = np.concatenate([SIZES.clip(max=1e8), -SIZES.clip(max=1e8)])
    for sign in (1, -1):
        moved = x * (1 + sign * change) + sign * change
        found = arctan_difference(x[None], (moved - x)[None])[0]
        assert_allclose(found, np.arctan(moved) - np.arctan(x), rtol=1e-9, atol=4e-16)


@pytest.mark.parametrize(
    ("count", "shape"),
    [(0, (9, 16)), (10_001, (9, 81)), (3, (2, SINGLE_THREAD_SIZE))],
)
def test_slices_do_not_change_the_product(count, shape):
    rng = np.random.default_rng(count)
    rows = rng.normal(size=(count, shape[0]))
    matrix = rng.normal(size=shape)
    expected = rows @ matrix
    for one, other in ((rows, matrix), (rows.copy("F"), matrix.copy("F"))):
        columns = blocked_matmul_columns(other.T, one.T)
        for found in (blocked_matmul(one, other), columns.T):
            assert_allclose(found, expected, rtol=1e-12, atol=1e-12)
