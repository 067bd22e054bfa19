"""Local-linear regression: leaving out one by one."""

import itertools

import numpy as np
from numpy.testing import assert_allclose

from uplift.atlas.sources import read_atlas
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.lab.methods import local_linear
from uplift.lab.runner import named_lights, spectra_of, spectrum_errors, within


def test_the_smoothing_has_the_least_leave_one_out_error(sensor, monkeypatch):
    """Compared with leaving out one by one."""
    known = spectra_of(within(read_atlas("tcs"), sensor), sensor)
    colours = sensor.rgb(known)
    lights = list(named_lights(SCENE_LIGHTS).values())

    def tuned(spectra, bandwidths, ridges):
        monkeypatch.setattr(local_linear, "BANDWIDTHS", bandwidths)
        monkeypatch.setattr(local_linear, "RIDGES", ridges)
        return local_linear.tune(sensor, spectra)

    def slow(choices):
        predicted = []
        for row in range(len(known)):
            others = np.delete(known, row, axis=0)
            predicted.append(tuned(others, *choices)(colours[row : row + 1])[0])
        return spectrum_errors(np.array(predicted), known, lights).delta_e.mean()

    best = min(itertools.product([(10.0,), (40.0,)], [(1e-6,), (1e-2,)]), key=slow)
    rgb = sensor.rgb(known.mean(axis=0)[None]) * [[0.9, 1.0, 1.1]]
    spectra = tuned(known, (10.0, 40.0), (1e-6, 1e-2))(rgb)
    assert_allclose(spectra, tuned(known, *best)(rgb), atol=1e-12)
    assert_allclose(sensor.rgb(spectra), rgb, atol=1e-6)
