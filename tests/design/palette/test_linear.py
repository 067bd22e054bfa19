"""Linear model: exact in the span of the basis, and symmetric."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.design.palette import LinearModel


@pytest.fixture
def pair(model):
    return np.random.default_rng(3).random((2, 5, model.count))


def test_products_of_spectra_in_the_basis_are_exact(model, pair):
    """They equal the projection of the full product."""
    first, second = pair
    product = LinearModel(model).product(first, second)
    whole = model.spectra(first) * model.spectra(second)
    np.testing.assert_allclose(product, whole @ model.projection.T, atol=1e-9)


def test_light_and_surface_may_be_exchanged(model, pair):
    linear = LinearModel(model)
    first, second = pair
    np.testing.assert_allclose(linear.product(first, second), linear.product(second, first), atol=1e-12)


def test_the_tensor_agrees_with_equation_6(model):
    i, j, k = 2, 0, 5
    by_hand = model.projection[i] @ (model.basis[:, j] * model.basis[:, k])
    assert LinearModel(model).tensor[i, j, k] == pytest.approx(by_hand, abs=1e-12)


def test_component_wise_products_are_its_diagonal_part(model):
    """Λ of the flat spectrum is that of the sum of the basis functions."""
    reflection = LinearModel(model).reflection(np.ones(model.count))
    whole = model.projection @ np.diag(model.basis.sum(axis=1)) @ model.basis
    np.testing.assert_allclose(reflection, whole, atol=1e-9)
