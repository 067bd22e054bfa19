"""Model spectra near given reflectances: the model's own are found, and colours survive few coefficients."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit.library import shipped_library
from uplift.fit.match_spectra import match_spectra, moment_matrix
from uplift.models import Moments, Phase, evaluate

GRID = observer.grid()
LIGHTS = [observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3")]
MODELS = [Moments(9), Moments(17), Moments(9, Phase(380.0, 780.0, "vision"))]


def ids(model):
    return f"{model.count}-{model.phase.warp}"


@pytest.mark.parametrize("model", MODELS, ids=ids)
def test_moments_of_sampled_spectra_are_those_of_the_model(model):
    multipliers = np.random.default_rng(2).normal(size=(20, model.count)) / (1 + np.arange(model.count)) ** 2
    spectra = evaluate(model, multipliers, GRID)
    np.testing.assert_allclose(spectra @ moment_matrix(model, GRID), model.to_storage(multipliers), atol=3e-4)


@pytest.mark.parametrize("model", MODELS, ids=ids)
def test_colours_of_measured_spectra_survive(model):
    measured = np.clip(shipped_library()[0].measured, 1e-3, 1 - 1e-3)
    plain = model.from_storage(measured @ moment_matrix(model, GRID))
    matched = match_spectra(model, GRID, measured, LIGHTS)

    def worst(multipliers):
        spectra = evaluate(model, multipliers, GRID)
        return np.max([delta_e_spectra(light, spectra, measured) for light in LIGHTS], axis=0).mean()

    assert worst(matched) < 0.7 * worst(plain)


def test_no_spectra_give_none():
    assert match_spectra(Moments(5), GRID, np.zeros((0, 81)), LIGHTS).shape == (0, 5)
