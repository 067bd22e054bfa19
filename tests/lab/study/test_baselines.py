"""Plain predictors of held-out materials."""

from __future__ import annotations

import numpy as np
import pytest

import uplift
from tests.conftest import ATLASES
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import SCENE_LIGHTS
from uplift.lab.study import baselines
from uplift.lab.study.baselines import centroid, local_linear, mismatch_centroids


@pytest.fixture(scope="module")
def data():
    return uplift.load().data


@pytest.fixture(scope="module")
def known(sensor):
    spectra = resample(read_atlas(ATLASES / "rawtoaces.txt"), sensor.wavelengths).values
    return spectra[sensor.contains(sensor.rgb(spectra))][::3]


def test_local_linear_reproduces_spectra_that_are_linear_in_rgb(data):
    sensor = data.sensor
    spectra = 0.5 + np.random.default_rng(0).uniform(-2, 2, (45, 3)) @ observer.light("A").xyz
    known, queried = spectra[:40], spectra[40:]
    np.testing.assert_allclose(local_linear(data, known, sensor.rgb(queried)), queried, atol=1e-3)


def test_local_linear_predictions_have_the_queried_colours(data, known):
    rgb = data.sensor.rgb(known.mean(axis=0)[None]) * [[0.9, 1.0, 1.1]]
    np.testing.assert_allclose(data.sensor.rgb(local_linear(data, known, rgb)), rgb, atol=1e-6)


def test_smoothing_has_the_least_leave_one_out_error(data, known, monkeypatch):
    """Against leaving out one by one."""
    monkeypatch.setattr(baselines, "BANDWIDTHS", (10.0, 40.0))
    monkeypatch.setattr(baselines, "RIDGES", (1e-6, 1e-2))
    some = known[:20]
    colours = data.sensor.rgb(some)
    lights = [observer.light(name) for name in SCENE_LIGHTS]

    def slow(smoothing):
        found = []
        for row, rest in enumerate(~np.eye(len(some), dtype=bool)):
            alone = colours[row : row + 1]
            spectra = baselines._regress(data.sensor, colours[rest], some[rest], alone, smoothing)
            found.append(baselines._exact(data, spectra, alone)[0])
        return np.mean([delta_e_spectra(light, np.array(found), some) for light in lights])

    every = [baselines.Smoothing(width, ridge) for width in (10.0, 40.0) for ridge in (1e-6, 1e-2)]
    assert baselines._best_smoothing(data, some, colours) == min(every, key=slow)


def test_centroid_of_a_tetrahedron_and_of_a_flat_body():
    corners = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    np.testing.assert_allclose(centroid(corners), [0.25] * 3)
    np.testing.assert_allclose(centroid(np.concatenate([corners, [[0.1, 0.1, 0.1]]])), [0.25] * 3)
    np.testing.assert_allclose(centroid(np.eye(3)), [1 / 3] * 3)


def test_mixtures_have_the_colour_and_their_centroid_too(sensor, known):
    colours = sensor.rgb(known[:10])
    rgb = colours.mean(axis=0)
    corners, weights = baselines._mixtures(colours, rgb)
    assert len(corners) >= 4
    np.testing.assert_allclose(np.einsum("vk,vkc->vc", weights, colours[corners]), rgb + 0 * corners[:, :3], atol=1e-9)
    own = mismatch_centroids(sensor, known[:10], rgb[None], [sensor.light])
    np.testing.assert_allclose(own[0, 0], sensor.xyz(rgb), atol=1e-6)


def test_colours_that_no_mixture_has_are_nan(sensor):
    grey = np.linspace(0.2, 0.6, 6)[:, None] * np.ones(len(sensor.wavelengths))
    red = np.array([[0.6, 0.1, 0.1]])
    assert np.isnan(mismatch_centroids(sensor, grey, red, [observer.light("A")])).all()
    assert mismatch_centroids(sensor, grey, np.zeros((0, 3)), [observer.light("A")]).shape == (0, 1, 3)
