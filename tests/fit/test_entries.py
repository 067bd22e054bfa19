"""Fitted atlas entries: exact colour, close spectrum, close colours under
other lights.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import leastsq

from tests.conftest import MACBETH
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit.entries import fit_entries, minimise, objective
from uplift.fit.problem import Problem
from uplift.models.model import evaluate
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3")
MODEL = Moments(9)


@pytest.fixture(scope="module")
def measured(sensor):
    spectra = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    return spectra[in_unit_cube(sensor.rgb(spectra))]


def goal_of(problem):
    return objective(problem.model, problem.forward.basis, problem.lights)


def problem_of(sensor, lights=LIGHTS, model=MODEL):
    """Entries keep their colours under the lights; errors are under the last."""
    lights = tuple(map(observer.light, lights))
    return Problem(sensor, model, lights, lights[-1])


def fitted(sensor, measured, lights=LIGHTS, **weights):
    found = fit_entries(
        problem_of(sensor, lights), measured, sensor.rgb(measured), **weights
    )
    return evaluate(MODEL, found.multipliers, sensor.wavelengths)


def delta_e(name, first, second):
    return delta_e_spectra(observer.light(name), first, second)


def test_colour_spectrum_and_lights_of_the_macbeth_entries(sensor, measured):
    """The colour-matching functions vanish at the ends of the spectrum."""
    found = fit_entries(problem_of(sensor), measured, sensor.rgb(measured))
    spectra = evaluate(MODEL, found.multipliers, sensor.wavelengths)
    assert np.abs(sensor.rgb(spectra) - sensor.rgb(measured)).max() <= 1e-6
    squares = (spectra - measured) ** 2
    assert np.sqrt(squares.mean(axis=1)).mean() <= 0.02
    assert np.sqrt(squares[:, np.r_[:8, 73:81]].mean()) <= 0.04
    for name, most in (("A", 0.15), ("FL2", 0.3), ("FL11", 0.6)):
        assert delta_e(name, spectra, measured).mean() <= most
    assert_allclose(found.error, delta_e("LED-B3", spectra, measured), atol=1e-9)


def test_colours_are_kept_under_the_lights_of_the_objective(sensor, measured):
    """Without FL11 in the objective, errors under FL11 grow."""
    with_light, without = (
        delta_e("FL11", fitted(sensor, measured, lights), measured).mean()
        for lights in (LIGHTS, ("D65",))
    )
    assert with_light < 0.8 * without


def steps_along_noise(sensor, spectrum, **weights):
    """Steps of fitted spectra while a measurement gains noise evenly, in units of the
    steps of the measurement.
    """
    noise = np.random.default_rng(2).normal(0, 0.002, (23, len(spectrum)))[22]
    path = np.clip(spectrum + np.linspace(0, 1, 41)[:, None] * noise, 1e-4, 1)
    changes = [
        np.linalg.norm(np.diff(each, axis=0), axis=1)
        for each in (path, fitted(sensor, path, **weights))
    ]
    return changes[1] / changes[0]


def test_fit_of_a_dark_entry_is_continuous_in_the_measurement(sensor, measured):
    """Black of the ColorChecker: without smoothness, noise of a spectrophotometer moves
    it to another minimum.
    """
    black = measured[-1]
    assert black.mean() < 0.05
    assert steps_along_noise(sensor, black).max() <= 8
    assert steps_along_noise(sensor, black, smoothness=0.0).max() >= 50


@pytest.mark.parametrize(
    "model", [Moments(9), Moments(17), Sigmoid()], ids=lambda m: f"{m.name}{m.count}"
)
def test_minima_are_those_of_minpack(sensor, measured, model):
    """Of a dark spectrum too, where L*a*b* is linear."""
    goal = goal_of(problem_of(sensor, model=model))
    measured = np.append(measured, 0.02 * measured[:1], axis=0)
    found = minimise(goal, measured)
    for multipliers, spectrum in zip(found, measured, strict=True):
        given = (spectrum, goal.colours(spectrum))
        theirs, _ = leastsq(goal.residuals, np.zeros(model.count), given)
        ours, other = (
            (goal.residuals(p, *given) ** 2).sum() for p in (multipliers, theirs)
        )
        assert ours <= other * (1 + 1e-6)
