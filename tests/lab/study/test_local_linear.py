"""Local-linear regression: spectra that are linear in RGB, leaving out one by one."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import ATLASES
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.sensor import in_unit_cube
from uplift.lab.study import local_linear as regression
from uplift.lab.study.local_linear import local_linear


@pytest.fixture(scope="module")
def data():
    return uplift.load().data


@pytest.fixture(scope="module")
def known(sensor):
    spectra = resample(read_atlas(ATLASES / "rawtoaces.txt"), sensor.wavelengths).values
    return spectra[in_unit_cube(sensor.rgb(spectra))][::3]


def test_local_linear_reproduces_spectra_that_are_linear_in_rgb(data):
    spectra = (
        0.5 + np.random.default_rng(0).uniform(-2, 2, (45, 3)) @ observer.light("A").xyz
    )
    known = spectra[:40]
    queried = spectra[40:]
    assert_allclose(
        local_linear(data, known, data.sensor.rgb(queried)), queried, atol=1e-3
    )


def test_local_linear_has_the_least_leave_one_out_error_and_the_queried_colours(
    data, known, monkeypatch
):
    """Compared with leaving out one by one."""
    monkeypatch.setattr(regression, "BANDWIDTHS", (10.0, 40.0))
    monkeypatch.setattr(regression, "RIDGES", (1e-6, 1e-2))
    known = known[:20]
    colours = data.sensor.rgb(known)

    def predict(known, rgb, smoothing):
        spectra = np.clip(
            regression.regress(data.sensor, known, rgb, *smoothing), 1e-4, 1 - 1e-4
        )
        return regression.with_least_change(data, spectra, rgb)

    def slow(smoothing):
        predicted = [
            predict(np.delete(known, row, axis=0), colours[row : row + 1], smoothing)
            for row in range(len(known))
        ]
        differences = [
            delta_e_spectra(observer.light(name), np.concatenate(predicted), known)
            for name in SCENE_LIGHTS
        ]
        return np.mean(differences)

    best = min(itertools.product((10.0, 40.0), (1e-6, 1e-2)), key=slow)
    rgb = data.sensor.rgb(known.mean(axis=0)[None]) * [[0.9, 1.0, 1.1]]
    spectra = local_linear(data, known, rgb)
    assert_allclose(spectra, predict(known, rgb, best), atol=1e-12)
    assert_allclose(data.sensor.rgb(spectra), rgb, atol=1e-6)
