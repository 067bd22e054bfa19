"""Answers of other methods at the colours of entries."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.observer import display_sensors
from uplift.lookup import load
from uplift.report.fidelity import JAKOB_HANIKA, WITHOUT_ATLAS, find_alternatives


@pytest.fixture(scope="module")
def found(judged):
    return {each.name: each for each in judged.alternatives}


def test_all_have_the_colours_of_the_entries(judged, found):
    sensor = judged.data.sensor
    for other in found.values():
        rgb = sensor.rgb(other.answer)
        np.testing.assert_allclose(rgb, judged.entries.rgb, rtol=0, atol=2e-3)
        assert other.answer.min() >= 0
        assert other.answer.max() <= 1


def test_without_atlas_is_the_packaged_cube(judged, found):
    rgb = load().data.sensor.rgb(judged.entries.target)
    expected = load().reflectance(np.clip(rgb, 0, 1))
    np.testing.assert_array_equal(found[WITHOUT_ATLAS].answer, expected)


def test_jakob_hanika_is_a_sigmoid_of_a_parabola(judged, found):
    answer = found[JAKOB_HANIKA].answer
    t = 2 * answer - 1
    linear = t / np.sqrt(1 - t**2)  # inverse of equation 5
    wavelengths = judged.data.sensor.wavelengths
    fit = np.polynomial.polynomial.polyfit(wavelengths, linear.T, 2)
    scale = np.abs(linear).max(axis=1, keepdims=True)
    parabola = np.polynomial.polynomial.polyval(wavelengths, fit)
    assert np.abs(parabola - linear).max() <= 1e-6 * scale.max()


def test_errors_agree_with_the_definition(judged, found):
    from uplift.colorimetry.delta_e import delta_e_spectra

    for other in found.values():
        for column, sensor in enumerate(judged.lights):
            expected = delta_e_spectra(sensor.light, other.answer, judged.entries.target)
            np.testing.assert_allclose(other.delta_e[:, column], expected, rtol=1e-12)
            assert other.mean[column] == pytest.approx(expected.mean())
            assert other.largest[column] == expected.max()


def test_the_atlas_helps(judged, found):
    lit = slice(1, None)  # all but the light that colours are matched under
    for other in found.values():
        assert judged.entries.delta_e[:, lit].mean() < other.delta_e[:, lit].mean()


def test_colours_outside_srgb_have_no_answer(judged):
    import dataclasses

    target = judged.entries.target.copy()
    target[0] = np.where(judged.data.sensor.wavelengths > 600, 1.0, 0.0)
    errors = dataclasses.replace(judged.entries, target=target)
    other = find_alternatives(judged.data, errors, display_sensors(("A",), judged.data.sensor.observer))[0]
    assert np.isnan(other.delta_e[0]).all()
    assert np.isnan(other.answer[0]).all()
    assert np.isfinite(other.delta_e[1:]).all()
    assert np.isfinite(other.mean).all()
