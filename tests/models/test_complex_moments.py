"""Multipliers of complex moments, compared with dense solvers."""

from __future__ import annotations

import numpy as np
from scipy.linalg import toeplitz

from uplift.models import complex_moments


def test_levinson_agrees_with_a_dense_solver():
    rng = np.random.default_rng(5)
    column = rng.normal(size=(20, 9)) + 1j * rng.normal(size=(20, 9))
    column[:, 0] = 12
    solution, scale, positive = complex_moments.levinson(column.T)
    assert positive.all()
    for row, q in zip(column, (solution / scale).T, strict=True):
        np.testing.assert_allclose(toeplitz(row) @ q, np.eye(9)[0], atol=1e-12)


def test_levinson_reports_matrices_that_are_not_positive():
    column = np.array([[1.0, 2.0], [-1.0, 0.1], [2.0, 0.5]], dtype=complex)
    with np.errstate(all="ignore"):
        *_, positive = complex_moments.levinson(column.T)
    assert positive.tolist() == [False, False, True]
