"""Criteria of Fishkin 1983, 10.4: which models pass them, and that every criterion can fail."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.design.mixing import criteria, kubelka_munk, pigments
from uplift.design.mixing.criteria import CRITERIA, evaluate
from uplift.design.mixing.mixers import Mixer, mixers
from uplift.design.mixing.scattering import dispersive

SELF, CHROMATICITY, DARKER, HUE, LIGHTER, GREY, GREEN = range(len(CRITERIA))
EXPECTED = {
    "pigments": {SELF, DARKER, LIGHTER, GREEN},
    "pigments in oil": {SELF, DARKER, LIGHTER},
    "pigments, S = √R": {SELF, DARKER, LIGHTER, GREEN},
    "pigments, S = 1": {SELF, DARKER, LIGHTER},
    "pigments, Amy": {DARKER, GREEN},
    "pigments, Duntley": {SELF, DARKER, LIGHTER, GREEN},
    "dyes": {SELF, DARKER, LIGHTER, GREEN},
    "filters": {DARKER, GREEN},
    "average": {SELF, CHROMATICITY, DARKER, HUE, LIGHTER},
    "product": {DARKER},
    "ryb": {SELF, CHROMATICITY, DARKER, HUE, LIGHTER, GREEN},
    "phosphors": {DARKER, GREEN},
}
"""Criteria that each model passes with some margin; with one constant, the green is at the limit."""


@pytest.fixture(scope="module")
def results(small_cube, paints):
    colours = np.array(list(paints.values()))
    return {one.name: evaluate(one, small_cube.data.sensor, colours) for one in mixers(small_cube)}


@pytest.mark.parametrize("name", EXPECTED)
def test_models_pass_the_expected_criteria(results, name):
    passed = {index for index, result in enumerate(results[name]) if result.passed}
    assert passed >= EXPECTED[name]


def test_every_model_is_evaluated(results):
    assert set(results) == set(EXPECTED)
    assert all(np.isfinite(result.value) for found in results.values() for result in found)


@pytest.mark.parametrize(
    ("mix", "failed"),
    [
        (lambda rgb, parts: np.full((*parts.shape[:-1], 3), 0.5), {SELF, DARKER, GREEN}),
        (
            lambda rgb, parts: np.full((*parts.shape[:-1], 3), [0.2, 0.1, 0.1]),
            {CHROMATICITY, LIGHTER, GREY},
        ),
        (lambda rgb, parts: (parts @ rgb)[..., [1, 2, 0]], {CHROMATICITY, HUE}),
    ],
)
def test_every_criterion_can_fail(small_cube, paints, mix, failed):
    found = evaluate(Mixer("", "", mix), small_cube.data.sensor, np.array(list(paints.values())))
    assert failed <= {index for index, result in enumerate(found) if not result.passed}


def test_blue_and_yellow_of_an_atlas_are_green(small_cube, paints):
    """Kubelka–Munk mixture of spectra from a ColorChecker cube."""
    pair = np.stack([paints["blue"], paints["yellow"]])
    spectra = small_cube.reflectance(pair)
    red, green, blue = small_cube.data.sensor.rgb(
        kubelka_munk.opaque_reflectance(pigments.from_opaque(spectra, dispersive(small_cube.data.sensor)).mix([1, 1]))
    )
    assert green > 1.05 * max(red, blue)
    average = pair.mean(axis=0)
    assert average[1] < average[0]


def test_hue_difference_is_an_angle(small_cube):
    sensor = small_cube.data.sensor
    red, cyan = np.array([1.0, 0, 0]), np.array([0, 1.0, 1.0])
    assert criteria._hue_difference(sensor, red, red) == pytest.approx(0, abs=1e-9)
    assert criteria._hue_difference(sensor, red, cyan) == pytest.approx(180, abs=1e-6)
    assert criteria._hue_difference(sensor, red, np.array([1, 0.5, 0])) == pytest.approx(
        criteria._hue_difference(sensor, np.array([1, 0.5, 0]), red)
    )
