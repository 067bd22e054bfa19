"""The criteria of 10.4: obeyed by the models that should, and able to fail."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.design.mixing import criteria, kubelka_munk, pigments
from uplift.design.mixing.criteria import CRITERIA, judge
from uplift.design.mixing.mixers import Mixer, mixers

SELF, CHROMATICITY, DARKER, HUE, LIGHTER, GREY, GREEN = range(len(CRITERIA))
OBEYED = {
    "pigments": {SELF, DARKER, LIGHTER, GREEN},
    "pigments in oil": {SELF, DARKER, LIGHTER},
    "pigments, one constant": {SELF, DARKER, LIGHTER, GREEN},
    "pigments, Amy": {DARKER, GREEN},
    "dyes": {SELF, DARKER, LIGHTER, GREEN},
    "filters": {DARKER, GREEN},
    "average": {SELF, CHROMATICITY, DARKER, HUE, LIGHTER},
    "product": {DARKER},
    "ryb": {SELF, CHROMATICITY, DARKER, HUE, LIGHTER, GREEN},
    "phosphors": {DARKER, GREEN},
}
"""What each model, by what it is, must obey."""


@pytest.fixture(scope="module")
def verdicts(small_cube, paints):
    colours = np.array(list(paints.values()))
    return {one.name: judge(one, small_cube.data.sensor, colours) for one in mixers(small_cube)}


@pytest.mark.parametrize("name", OBEYED)
def test_models_obey_what_they_should(verdicts, name):
    obeyed = {place for place, verdict in enumerate(verdicts[name]) if verdict.obeys}
    assert obeyed >= OBEYED[name]


def test_every_model_is_judged(verdicts):
    assert set(verdicts) == set(OBEYED)
    assert all(np.isfinite(verdict.value) for found in verdicts.values() for verdict in found)


@pytest.mark.parametrize(
    ("mix", "broken"),
    [
        (lambda rgb, parts: np.full((*parts.shape[:-1], 3), 0.5), {SELF, DARKER, GREEN}),
        (
            lambda rgb, parts: np.full((*parts.shape[:-1], 3), [0.2, 0.1, 0.1]),
            {CHROMATICITY, LIGHTER, GREY},
        ),
        (lambda rgb, parts: (parts @ rgb)[..., [1, 2, 0]], {CHROMATICITY, HUE}),
    ],
)
def test_every_criterion_can_be_broken(small_cube, paints, mix, broken):
    found = judge(Mixer("", "", mix), small_cube.data.sensor, np.array(list(paints.values())))
    assert broken <= {place for place, verdict in enumerate(found) if not verdict.obeys}


def test_blue_and_yellow_of_an_atlas_are_green(small_cube, paints):
    """Kubelka and Munk, spectra uplifted by a cube of the ColorChecker."""
    pair = np.stack([paints["blue"], paints["yellow"]])
    spectra = small_cube.reflectance(pair)
    red, green, blue = small_cube.data.sensor.rgb(
        kubelka_munk.hiding(pigments.of_hiding(spectra).mixed([1, 1]))
    )
    assert green > 1.05 * max(red, blue)
    average = pair.mean(axis=0)
    assert average[1] < average[0]


def test_a_turn_is_measured_as_an_angle(small_cube):
    sensor = small_cube.data.sensor
    red, cyan = np.array([1.0, 0, 0]), np.array([0, 1.0, 1.0])
    assert criteria._turn(sensor, red, red) == pytest.approx(0, abs=1e-9)
    assert criteria._turn(sensor, red, cyan) == pytest.approx(180, abs=1e-6)
    assert criteria._turn(sensor, red, np.array([1, 0.5, 0])) == pytest.approx(
        criteria._turn(sensor, np.array([1, 0.5, 0]), red)
    )
