"""Atlas entries as spectra of the model: the colour exactly, spectrum and lights closely."""

from __future__ import annotations

import numpy as np
import pytest

from uplift import observer
from uplift.atlas import on_grid, read_atlas
from uplift.difference import delta_e_2000, lab
from uplift.fit.entries import fit_entries
from uplift.models import Moments
from uplift.models.least_change import forward

from ..conftest import MACBETH

LIGHTS = ("D65", "A", "FL2", "FL11")


@pytest.fixture(scope="module")
def measured(sensor):
    spectra = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    return spectra[sensor.holds(sensor.rgb(spectra))]


def fitted(sensor, measured, lights=LIGHTS):
    model = Moments(9)
    ahead = forward(model, sensor.wavelengths, sensor.matrix)
    shine = [observer.light(name) for name in lights]
    found = fit_entries(model, ahead, measured, sensor.rgb(measured), shine, 1e-6)
    return model.squash(found @ ahead.basis.T)


def mean_delta_e(name, first, second):
    light = observer.light(name)
    return delta_e_2000(*(lab(spectra @ light.xyz.T, light.white) for spectra in (first, second))).mean()


def test_colour_spectrum_and_lights_of_the_macbeth_entries(sensor, measured):
    spectra = fitted(sensor, measured)
    assert np.abs(sensor.rgb(spectra) - sensor.rgb(measured)).max() <= 1e-6
    assert np.sqrt(((spectra - measured) ** 2).mean(axis=1)).mean() <= 0.02
    assert mean_delta_e("A", spectra, measured) <= 0.15
    assert mean_delta_e("FL2", spectra, measured) <= 0.30
    assert mean_delta_e("FL11", spectra, measured) <= 0.60


def test_the_lights_that_are_asked_for_are_those_that_hold(sensor, measured):
    """Leaving FL11 out makes FL11 worse: the lights have a say."""
    without = fitted(sensor, measured, ("D65",))
    assert mean_delta_e("FL11", fitted(sensor, measured), measured) < 0.8 * mean_delta_e(
        "FL11", without, measured
    )


def test_no_atlas_no_entries(sensor):
    model = Moments(9)
    ahead = forward(model, sensor.wavelengths, sensor.matrix)
    none = fit_entries(model, ahead, np.zeros((0, 81)), np.zeros((0, 3)), [observer.light("D65")], 1e-6)
    assert none.shape == (0, 9)
