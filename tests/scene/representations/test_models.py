"""Trigonometric moments, sigmoid, linear model and hero wavelengths."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.observer import grid
from uplift.lab.study.moments import Technique
from uplift.models import Sigmoid
from uplift.models.model import evaluate
from uplift.scene.representations.models import fit_sigmoids, hero_wavelengths, linear_model, trigonometric_moments
from uplift.scene.representations.samples import wavelengths, xyz_weights


def test_moments_equal_the_integrals(checker):
    actual = trigonometric_moments(9).encode_surface(checker.surfaces)
    exact = Technique(mirrored=True, warped=False).moments(checker.surfaces, wavelengths(), 8)
    np.testing.assert_allclose(actual, exact, atol=2e-5)


def test_fit_recovers_sigmoids():
    known = np.array([[-1.0, 2.0, 0.5], [3.0, -1.0, -2.0], [0.3, 0.2, 0.1]])
    table = evaluate(Sigmoid(), known, grid())
    np.testing.assert_allclose(evaluate(Sigmoid(), fit_sigmoids(Sigmoid(), table), grid()), table, atol=1e-6)


def test_sigmoids_approach_black_and_white():
    table = np.array([np.zeros(81), np.ones(81)])
    np.testing.assert_allclose(evaluate(Sigmoid(), fit_sigmoids(Sigmoid(), table), grid()), table, atol=0.01)


def test_linear_model_of_all_components_is_exact(checker, light_powers):
    power, surfaces = checker.powers[:1], checker.surfaces[:5]
    model = linear_model(6, power, surfaces)  # five products and the light
    light = model.encode_light(np.tile(power, (5, 1)))
    actual = model.xyz(model.multiply(light, model.encode_surface(surfaces)))
    np.testing.assert_allclose(actual, (power * surfaces) @ xyz_weights(), rtol=1e-6)
    np.testing.assert_allclose(model.basis.T @ model.basis, np.eye(6), atol=1e-12)


@pytest.mark.parametrize("paths", [1, 8])
def test_hero_wavelengths_are_a_quarter_apart_and_stratified(paths):
    drawn = hero_wavelengths(paths).wavelengths(500)
    assert drawn.shape == (500, 4 * paths)
    assert drawn.min() >= 380
    assert drawn.max() <= 780
    low, high = np.tanh(0.0072 * (np.array([380, 780]) - 538))
    shares = (np.tanh(0.0072 * (drawn - 538)) - low) / (high - low)
    # Each row has equal numbers in each quarter, and so in each stratum of a quarter.
    strata = np.floor(shares * 4 * paths + 1e-9).clip(0, 4 * paths - 1).astype(int)
    quarters = np.sort(strata // paths, axis=1)
    np.testing.assert_array_equal(quarters, np.tile(np.repeat(range(4), paths), (500, 1)))


def test_hero_wavelengths_are_unbiased_and_variance_falls_with_paths(checker):
    power = checker.powers[:1] * checker.surfaces[:1]
    spread = []
    for paths in (1, 8):
        hero = hero_wavelengths(paths)
        actual = hero.xyz(hero.encode_light(np.tile(power, (4000, 1))))
        error = actual.std(axis=0) / np.sqrt(len(actual))
        assert (np.abs(actual.mean(axis=0) - power @ xyz_weights()) < 4 * error + 1e-5).all()
        spread.append(actual.std(axis=0).max())
    assert spread[1] < spread[0] / 8**0.5
