"""Sliced matrix products."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from uplift.models.matmul import SINGLE_THREAD_SIZE, matmul_columns, matmul_rows


@pytest.mark.parametrize(
    ("count", "shape"),
    [(0, (9, 16)), (1, (81, 3)), (10_001, (9, 81)), (5_000, (17, 400)), (3, (2, SINGLE_THREAD_SIZE))],
)
def test_slices_do_not_change_the_product(count, shape):
    rng = np.random.default_rng(count)
    rows, matrix = rng.normal(size=(count, shape[0])), rng.normal(size=shape)
    for one, other in ((rows, matrix), (rows.copy("F"), matrix.copy("F"))):
        np.testing.assert_allclose(matmul_rows(one, other), rows @ matrix, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(matmul_columns(other.T, one.T), (rows @ matrix).T, rtol=1e-12, atol=1e-12)


def test_non_contiguous_columns():
    matrix, columns = np.arange(6.0).reshape(2, 3), np.arange(30.0).reshape(3, 10)
    np.testing.assert_allclose(matmul_columns(matrix, columns[:, 3:7]), (matrix @ columns)[:, 3:7])


def test_jax_arrays_stay_jax_arrays():
    found = matmul_rows(jnp.ones((5, 3)), jnp.ones((3, 2)))
    assert isinstance(found, jnp.ndarray)
    assert (found == 3).all()
