"""The prior: the spectrum of an entry at its colour, and standard errors of left-out
entries.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import ATLASES
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit.entries import fit_entries
from uplift.fit.kernel_learning import MIN_ENTRIES
from uplift.fit.prior import STEEP, _bounded, fit_prior
from uplift.fit.problem import Problem
from uplift.models.model import evaluate, reflectance
from uplift.models.moments import Moments

LIGHT = observer.light("A")
LIGHTS = tuple(observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3"))
SPLITS = 6


@pytest.fixture(scope="module")
def problem(sensor):
    return Problem(sensor, Moments(9), LIGHTS, LIGHT)


@pytest.fixture(scope="module")
def materials(problem, sensor):
    """The materials of rawtoaces within sRGB."""
    measured = resample(
        read_atlas(ATLASES / "rawtoaces.txt"), sensor.wavelengths
    ).values
    measured = measured[in_unit_cube(sensor.rgb(measured))]
    return fit_entries(problem, measured, sensor.rgb(measured))


def test_start_at_an_entry_is_nearer_to_its_spectrum_than_the_base(
    problem, sensor, materials
):
    few = materials.rows(np.arange(0, 160, 20))
    prior = fit_prior(problem, few)
    own = evaluate(problem.model, few.multipliers, sensor.wavelengths)
    with_entries, without = (
        np.sqrt(
            ((evaluate(problem.model, start, sensor.wavelengths) - own) ** 2).mean()
        )
        for start in (
            prior(few.rgb),
            problem.model.from_storage(prior.base.coefficients(few.rgb)),
        )
    )
    assert with_entries < without / 4


def test_start_far_from_all_entries_is_smooth(problem, sensor, materials):
    dark = materials.rgb.max(axis=1) < 0.2
    prior = fit_prior(problem, materials.rows(dark))
    light = np.linspace(0.6, 0.9, 4)[:, None].repeat(3, axis=1)
    smooth = reflectance(
        problem.model, prior.base.coefficients(light), sensor.wavelengths
    )
    assert_allclose(
        evaluate(problem.model, prior(light), sensor.wavelengths), smooth, atol=0.05
    )


def test_a_deviation_that_leaves_the_moment_space_is_shrunk(problem):
    grey = problem.model.to_storage(np.zeros((2, 9)))
    away = np.zeros((2, 9))
    away[:2, 3] = 0.05, 5
    found = _bounded(problem.model, grey, away)
    assert_allclose(problem.model.to_storage(found)[0], (grey + away)[0], atol=1e-7)
    shrunk = problem.model.to_storage(found)[1] - grey[1]
    assert 0.1 < shrunk[3] < 5
    assert_allclose(np.delete(shrunk, 3), 0, atol=1e-6)


def test_a_deviation_that_ends_in_a_box_is_shrunk(problem):
    model = problem.model
    grey = model.to_storage(np.zeros((1, model.count)))
    away = np.zeros((1, model.count))
    away[:, 3] = 1.0
    low = 0.0
    high = 1e3
    for _ in range(60):
        middle = (low + high) / 2
        valid = model.try_from_storage(grey + middle * away)[1].all()
        low, high = (middle, high) if valid else (low, middle)
    box = 0.99999 * low * away
    assert np.abs(model.from_storage(grey + box)).max() > STEEP
    found = _bounded(model, grey, box)
    assert 0.1 < np.abs(found).max() <= STEEP


def test_too_few_entries_give_no_standard_error(problem, sensor, materials):
    for count, tells in (
        (0, False),
        (1, False),
        (MIN_ENTRIES - 1, False),
        (MIN_ENTRIES, True),
    ):
        prior = fit_prior(problem, materials.rows(np.arange(count)))
        errors = prior.standard_error(np.full((1, 3), 0.3))
        assert (errors is not None) == tells


def test_errors_of_left_out_entries_agree_with_the_standard_error(
    problem, sensor, materials
):
    """Half the materials are the atlas, the other half is predicted; repeated several
    times.

    Errors of materials have heavy tails: a single split is off by up to half.
    """
    rng = np.random.default_rng(0)
    missed = []
    stated = []
    for _ in range(SPLITS):
        order = rng.permutation(len(materials.rgb))
        half = len(order) // 2
        prior = fit_prior(problem, materials.rows(order[:half]))
        queried = materials.rows(order[half:])
        found = problem.solve(queried.rgb, prior(queried.rgb), 16).multipliers
        spectra = evaluate(problem.model, found, sensor.wavelengths)
        missed.append(delta_e_spectra(LIGHT, spectra, queried.measured))
        stated.append(prior.standard_error(queried.rgb))
    missed = np.concatenate(missed)
    stated = np.concatenate(stated)
    assert 0.8 < np.sqrt((missed**2).mean() / (stated**2).mean()) < 1.25
    assert 0.63 < (missed < stated).mean() < 0.73
    assert 0.92 < (missed < 2 * stated).mean() < 0.98
