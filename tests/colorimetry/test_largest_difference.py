"""The largest colour difference of metamers."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.extreme_spectra import extreme_spectra
from uplift.colorimetry.mismatch import largest_difference, mismatch_volumes


def mixed_metamers(sensor, light, rgb, count):
    """XYZ of metamers of one colour: extremes in random directions, and mixtures of pairs of them."""
    rng = np.random.default_rng(5)
    response = rng.normal(size=(count, 3)) @ light.xyz
    spectra = extreme_spectra(sensor.matrix, np.tile(rgb, (count, 1)), response).reflectance
    shares = rng.uniform(size=(count, 1))
    return np.concatenate([spectra, shares * spectra + (1 - shares) * spectra[::-1]]) @ light.xyz.T


@pytest.mark.parametrize("name", ["A", "FL11"])
def test_no_metamer_differs_more(plain_cube, name):
    cube, light = plain_cube, observer.light(name)
    sensor = cube.data.sensor
    rgb = np.random.default_rng(6).uniform(0.05, 0.95, size=(6, 3))
    answers = cube.reflectance(rgb) @ light.xyz.T
    found = largest_difference(mismatch_volumes(sensor, light, rgb, divisions=3), answers)
    assert (found.outer >= found.delta_e_2000).all()
    for row, colour in enumerate(rgb):
        metamers = lab(mixed_metamers(sensor, light, colour, 300), light.white)
        differences = delta_e_2000(metamers, lab(answers[row], light.white))
        assert differences.max() <= found.delta_e_2000[row] + 0.05
        assert differences.max() > 0.8 * found.delta_e_2000[row]


def test_the_difference_is_that_of_the_metamer(plain_cube):
    light, rgb = observer.light("HP1"), np.array([[0.3, 0.2, 0.6]])
    volumes = mismatch_volumes(plain_cube.data.sensor, light, rgb)
    answer = plain_cube.reflectance(rgb) @ light.xyz.T
    found = largest_difference(volumes, answer)
    difference = delta_e_2000(lab(found.xyz, light.white), lab(answer, light.white))
    np.testing.assert_allclose(found.delta_e_2000, difference)
    assert volumes.excess(found.xyz).max() <= 1e-9
    assert found.delta_e_2000[0] >= delta_e_2000(volumes.lab[0], lab(answer, light.white)).max()


def test_under_the_build_light_nothing_differs(plain_cube):
    sensor, rgb = plain_cube.data.sensor, np.random.default_rng(7).uniform(size=(5, 3))
    answers = plain_cube.reflectance(rgb) @ sensor.light.xyz.T
    found = largest_difference(mismatch_volumes(sensor, sensor.light, rgb), answers)
    assert found.delta_e_2000.max() < 1e-3
