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
from uplift.colorimetry.delta_e import delta_e_2000, lab, lab_jacobian
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
    lights = tuple(map(observer.light, lights))
    return Problem(sensor, model, lights, lights[0])


def fitted(sensor, measured, lights=LIGHTS, **weights):
    found = fit_entries(
        problem_of(sensor, lights), measured, sensor.rgb(measured), **weights
    )
    return evaluate(MODEL, found.multipliers, sensor.wavelengths)


def mean_delta_e(name, first, second):
    light = observer.light(name)
    return delta_e_2000(
        *(lab(spectra @ light.xyz.T, light.white) for spectra in (first, second))
    ).mean()


def test_colour_spectrum_and_lights_of_the_macbeth_entries(sensor, measured):
    spectra = fitted(sensor, measured)
    assert np.abs(sensor.rgb(spectra) - sensor.rgb(measured)).max() <= 1e-6
    assert np.sqrt(((spectra - measured) ** 2).mean(axis=1)).mean() <= 0.02
    assert mean_delta_e("A", spectra, measured) <= 0.15
    assert mean_delta_e("FL2", spectra, measured) <= 0.30
    assert mean_delta_e("FL11", spectra, measured) <= 0.60


def test_colours_are_kept_under_the_lights_of_the_objective(sensor, measured):
    """Without FL11 in the objective, errors under FL11 grow."""
    without = fitted(sensor, measured, ("D65",))
    assert mean_delta_e(
        "FL11", fitted(sensor, measured), measured
    ) < 0.8 * mean_delta_e("FL11", without, measured)


def test_the_ends_of_the_spectrum_follow_the_measurement(sensor, measured):
    """The colour-matching functions vanish there."""
    ends = np.r_[:8, 73:81]
    assert np.sqrt(((fitted(sensor, measured) - measured)[:, ends] ** 2).mean()) <= 0.04


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


def jacobian(goal, multipliers):
    """Derivative (m, C) of the residuals at multipliers (C,), row by row of the
    objective.
    """
    x = goal.basis @ multipliers
    change = goal.model.derivative(x)[:, None] * goal.basis
    colours = lab_jacobian(goal.lights @ goal.model.to_reflectance(x), goal.whites) @ (
        goal.lights @ change
    )
    own = np.diag(goal.multipliers)
    return np.concatenate(
        [goal.values * change, goal.weight * colours.reshape(-1, len(own)), own]
    )


@pytest.mark.parametrize("model", [Moments(5), Sigmoid()], ids=lambda m: m.name)
def test_normal_equations_are_those_of_central_differences(sensor, measured, model):
    """Of a dark spectrum too, where L*a*b* is linear."""
    goal = goal_of(problem_of(sensor, model=model))
    colours = goal.colours(measured[0])
    rng = np.random.default_rng(6)
    for level in (-80, -1, 0.5):
        at = rng.normal(size=model.count) + level * model.constant()
        numeric = []
        for step in 1e-5 * np.eye(model.count):
            after = goal.residuals(at + step, measured[0], colours)
            before = goal.residuals(at - step, measured[0], colours)
            numeric.append((after - before) / 2e-5)
        plain = jacobian(goal, at)
        residuals = goal.residuals(at, measured[0], colours)
        assert_allclose(plain, np.transpose(numeric), rtol=1e-5, atol=1e-8)
        gram, slope = goal.normal_equations(at[None], residuals[None])
        assert_allclose(gram[0], plain.T @ plain, rtol=1e-10, atol=1e-14)
        assert_allclose(slope[0], plain.T @ residuals, rtol=1e-10, atol=1e-14)


@pytest.mark.parametrize(
    "model", [Moments(9), Moments(17), Sigmoid()], ids=lambda m: f"{m.name}{m.count}"
)
def test_minima_are_those_of_minpack(sensor, measured, model):
    goal = goal_of(problem_of(sensor, model=model))
    found = minimise(goal, measured)
    for multipliers, spectrum in zip(found, measured, strict=True):
        given = (spectrum, goal.colours(spectrum))
        theirs, *_ = leastsq(
            goal.residuals,
            np.zeros(model.count),
            given,
            lambda p, *_: jacobian(goal, p),
            full_output=True,
            ftol=1e-8,
        )
        ours, other = (
            (goal.residuals(p, *given) ** 2).sum() for p in (multipliers, theirs)
        )
        assert ours <= other * (1 + 1e-6)


def test_error_is_the_difference_between_fit_and_measurement(sensor, measured):
    found = fit_entries(problem_of(sensor, ("A",)), measured, sensor.rgb(measured))
    spectra = evaluate(MODEL, found.multipliers, sensor.wavelengths)
    for row in range(len(measured)):
        assert found.error[row] == pytest.approx(
            mean_delta_e("A", spectra[row], measured[row])
        )


def test_an_empty_atlas_has_no_fitted_entries(sensor):
    none = fit_entries(problem_of(sensor), np.zeros((0, 81)), np.zeros((0, 3)))
    assert (none.multipliers.shape, none.error.shape) == ((0, 9), (0,))
