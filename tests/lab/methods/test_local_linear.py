"""Local-linear regression: spectra that are linear in RGB, leaving out one by one."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.atlas import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.lab.methods import local_linear as regression
from uplift.lab.methods.local_linear import regress, squared_distances, tune
from uplift.lab.runner import named_lights, spectra_of, spectrum_errors, within


@pytest.fixture(scope="module")
def known(sensor):
    return spectra_of(within(read_atlas("rawtoaces"), sensor), sensor)[::9]


def test_spectra_that_are_linear_in_rgb_are_reproduced(sensor):
    weights = np.random.default_rng(0).uniform(-2, 2, (45, 3))
    spectra = 0.5 + weights @ observer.light("A").xyz
    found = tune(sensor, spectra[:40])(sensor.rgb(spectra[40:]))
    assert_allclose(found, spectra[40:], atol=1e-3)


def test_the_smoothing_has_the_least_leave_one_out_error(sensor, known, monkeypatch):
    """Compared with leaving out one by one."""
    monkeypatch.setattr(regression, "BANDWIDTHS", (10.0, 40.0))
    monkeypatch.setattr(regression, "RIDGES", (1e-6, 1e-2))
    colours = sensor.rgb(known)
    lights = list(named_lights(SCENE_LIGHTS).values())

    def predict(known, rgb, smoothing):
        squares = squared_distances(sensor, rgb, sensor.rgb(known))
        return regress(sensor, known, rgb, squares, smoothing)

    def slow(smoothing):
        predicted = [
            predict(np.delete(known, row, axis=0), colours[row : row + 1], smoothing)
            for row in range(len(known))
        ]
        spectra = np.concatenate(predicted)
        return spectrum_errors(spectra, known, lights).delta_e.mean()

    best = min(itertools.product((10.0, 40.0), (1e-6, 1e-2)), key=slow)
    rgb = sensor.rgb(known.mean(axis=0)[None]) * [[0.9, 1.0, 1.1]]
    spectra = tune(sensor, known)(rgb)
    assert_allclose(spectra, predict(known, rgb, best), atol=1e-12)
    assert_allclose(sensor.rgb(spectra), rgb, atol=1e-6)
