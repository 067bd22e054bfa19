"""Extreme reflectances compared with a linear program of scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog

from uplift.colorimetry import observer
from uplift.colorimetry.extreme_spectra import extreme_spectra, first_basis

LIGHTS = ("A", "FL11", "HP1", "D65")


def problems(sensor, name, count):
    """RGB of random smooth reflectances, and responses in random directions of XYZ under a light."""
    rng = np.random.default_rng(7)
    smooth = np.cumsum(rng.normal(scale=0.3, size=(count, len(sensor.wavelengths))), axis=1)
    rgb = sensor.rgb(1 / (1 + np.exp(-smooth)))
    return rgb, rng.normal(size=(count, 3)) @ observer.light(name).xyz


@pytest.mark.parametrize("name", LIGHTS)
def test_extremes_are_those_of_a_linear_program(sensor, name):
    rgb, response = problems(sensor, name, 12)
    found = extreme_spectra(sensor.matrix, rgb, response)
    assert found.solved.all()
    for row in range(len(rgb)):
        best = linprog(-response[row], A_eq=sensor.matrix, b_eq=rgb[row], bounds=(0, 1), method="highs")
        assert response[row] @ found.reflectance[row] == pytest.approx(-best.fun, abs=1e-9)


def test_extremes_have_the_colour_and_at_most_three_inner_values(sensor):
    rgb, response = problems(sensor, "FL11", 500)
    found = extreme_spectra(sensor.matrix, rgb, response).reflectance
    np.testing.assert_allclose(sensor.rgb(found), rgb, atol=1e-9)
    assert ((found >= 0) & (found <= 1)).all()
    assert (((found > 0) & (found < 1)).sum(axis=1) <= 3).all()


def test_answers_do_not_depend_on_the_start_or_the_neighbours(sensor, monkeypatch):
    rgb, response = problems(sensor, "A", 40)
    found = extreme_spectra(sensor.matrix, rgb, response)
    warm = extreme_spectra(sensor.matrix, rgb, response, np.roll(found.basis, 1, axis=0))
    np.testing.assert_allclose(
        (warm.reflectance * response).sum(axis=1), (found.reflectance * response).sum(axis=1), atol=1e-9
    )
    monkeypatch.setattr("uplift.colorimetry.extreme_spectra.BLOCK_NUMBERS", 81 * 7)
    blocks = extreme_spectra(sensor.matrix, rgb, response)
    np.testing.assert_allclose(blocks.reflectance, found.reflectance, atol=1e-10)


def test_colours_without_reflectance_are_not_solved(sensor):
    rgb = np.array([[0.5, 0.5, 0.5], [1.5, 0, 0], [-0.4, 1, -0.4]])
    response = np.tile(observer.light("A").xyz[1], (3, 1))
    assert extreme_spectra(sensor.matrix, rgb, response).solved.tolist() == [True, False, False]


def test_the_first_basis_is_independent(sensor):
    assert np.linalg.cond(sensor.matrix[:, first_basis(sensor.matrix)]) < 100
