"""Spikes, Fourier coefficients, and the composite models."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.colorimetry import observer
from uplift.scene.representations.composite import enhanced_riemann, fourier_coefficients, split_spikes, sun_composite
from uplift.scene.representations.samples import hat_functions, xyz_weights

TABLES = arrays(float, (2, 81), elements=st.floats(0, 100, width=32))


def dense(table):
    return table @ hat_functions(observer.grid())


@settings(max_examples=25)
@given(TABLES, st.sampled_from([0.1, 0.2, 0.3]))
def test_smooth_part_is_the_largest_with_limited_gradient(table, threshold):
    rest, spikes = split_spikes(dense(table), threshold)
    distance = np.abs(np.arange(81)[:, None] - np.arange(81))
    steepest = threshold * table.max(axis=1)[:, None, None]
    oracle = (table[:, None, :] + steepest * distance).min(axis=2)
    scale = max(table.max(), 1)
    np.testing.assert_allclose(rest[:, ::5], oracle, atol=2e-9 * scale)
    whole = rest[:, ::5].copy()
    whole[:, spikes.positions] += spikes.heights
    np.testing.assert_allclose(whole, table, atol=1e-12 * scale)
    assert (spikes.heights >= 0).all()
    np.testing.assert_array_equal(spikes.storage, 2 * (spikes.heights > 0).sum(axis=1))


@pytest.mark.parametrize("count", [1, 5, 15])
def test_fourier_coefficients_equal_equation_4_7(count):
    table = np.random.default_rng(6).random((2, 81))
    phase = np.arange(1, 81) * 2 * np.pi / 80
    actual = fourier_coefficients(count).encode_light(dense(table))
    table[:, 80] = (table[:, 0] + table[:, 80]) / 2
    np.testing.assert_allclose(actual[:, 0], table[:, 1:].mean(axis=1))  # ã_0 / 2 of eq. 4.7
    for order in range(1, count // 2 + 1):
        for place, wave in ((2 * order - 1, np.cos), (2 * order, np.sin)):
            np.testing.assert_allclose(actual[:, place], (table[:, 1:] @ wave(order * phase)) * 2 / 80, atol=1e-12)


@pytest.mark.parametrize("count", [3, 7])
def test_product_of_fourier_series_is_not_aliased(count):
    one, rng = fourier_coefficients(count), np.random.default_rng(7)
    first, second = rng.random((2, 4, count))
    whole = (first @ one.waves) * (second @ one.waves)
    table = np.concatenate([np.ones((1, 400)), one.waves[1:, :400]])
    kept = (whole[:, :400] @ table.T) / (table**2).sum(axis=1)
    np.testing.assert_allclose(one.multiply(first, second), kept, atol=1e-12)


@pytest.mark.parametrize("make", [sun_composite, enhanced_riemann])
def test_spikes_multiply_exactly_on_constant_spectra(make):
    one = replace(make(7), threshold=1e-9)  # all of a spike belongs to the spikes
    light, surface = np.full((1, 81), 2.0), np.full((1, 81), 0.25)
    light[0, 40] += 30.0
    surface[0, 60] += 0.5
    surface[0, 40] += 0.6
    actual = one.multiply(one.encode_light(dense(light)), one.encode_surface(dense(surface)))
    assert actual.spikes.positions.tolist() == [40, 60]
    np.testing.assert_allclose(one.xyz(actual), dense(light * surface) @ xyz_weights(), rtol=1e-6)
    assert one.storage(actual).tolist() == [7 + 4]
