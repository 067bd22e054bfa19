"""Point samples, Riemann sums and Gaussian quadrature against direct computations."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.scene.representations.samples import (
    gauss_samples,
    point_samples,
    riemann_sums,
    sample_points,
    wavelengths,
    xyz_weights,
)

RANDOM = np.random.default_rng(5).random((3, 401))


@pytest.mark.parametrize("count", [4, 9, 32])
def test_point_samples_are_linear_interpolation_both_ways(count):
    samples, places = point_samples(count), np.linspace(380, 780, count)
    assert sample_points(count)[[0, -1]].tolist() == [380, 780]
    taken = samples.encode_light(RANDOM)
    np.testing.assert_allclose(taken, [np.interp(places, wavelengths(), row) for row in RANDOM], rtol=1e-12)
    back = np.array([np.interp(wavelengths(), places, row) for row in taken])
    np.testing.assert_allclose(samples.xyz(taken), back @ xyz_weights(), rtol=1e-12)


@pytest.mark.parametrize("count", [4, 16])
def test_riemann_sums_are_means_of_cells(count):
    fine = np.repeat(RANDOM, 16 * count, axis=1)  # 401 · 16 · count samples fill the cells evenly
    means = fine.reshape(len(RANDOM), count, -1).mean(axis=2)
    np.testing.assert_allclose(riemann_sums(count).encode_surface(RANDOM), means, rtol=1e-12)
    weights = np.repeat(xyz_weights(), 16 * count, axis=0).reshape(count, -1, 3).sum(axis=1) / (16 * count)
    np.testing.assert_allclose(riemann_sums(count).weights, weights, rtol=1e-12)


@pytest.mark.parametrize("count", [4, 8, 16])
def test_quadrature_is_exact_for_polynomials(count):
    x = (wavelengths() - 580) / 200
    rule = gauss_samples(count)
    for degree in range(count):
        power = np.polynomial.chebyshev.chebval(x, np.eye(degree + 1)[-1])[None]
        # Spectra are linear between dense samples, so the rule is only approximate.
        np.testing.assert_allclose(rule.xyz(rule.encode_light(power)), power @ xyz_weights(), atol=1e-3)
