"""The prior: the spectrum of an entry at its colour, and standard errors of left-out
entries.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import ATLASES
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit.entries import fit_entries
from uplift.fit.kernel_learning import MIN_ENTRIES
from uplift.fit.prior import STEEP, _bounded, fit_prior
from uplift.models.model import evaluate, reflectance


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
    start = evaluate(problem.model, prior(few.rgb), sensor.wavelengths)
    base = reflectance(
        problem.model, prior.base.coefficients(few.rgb), sensor.wavelengths
    )
    assert ((start - own) ** 2).mean() < ((base - own) ** 2).mean() / 16


def test_a_deviation_that_leaves_the_moment_space_or_ends_in_a_box_is_shrunk(problem):
    """Of a grey, order 3 alone may deviate by 1 / π: a box of period 2 π / 3."""
    model = problem.model
    grey = model.to_storage(np.zeros((3, 9)))
    away = np.zeros((3, 9))
    away[:, 3] = 0.05, 0.99999 / np.pi, 5
    multipliers, valid = model.try_from_storage(grey + away)
    assert valid.tolist() == [True, True, False]
    assert np.abs(multipliers[1]).max() > STEEP
    found = _bounded(model, grey, away)
    assert np.abs(found).max() <= STEEP
    shrunk = (model.to_storage(found) - grey) / away[:, 3:4]
    assert_allclose(shrunk[:, 3], [1, 0.7, 0.7**8], atol=1e-4)
    assert_allclose(np.delete(shrunk, 3, axis=1), 0, atol=1e-4)


def test_too_few_entries_give_no_standard_error(problem, materials):
    for count in (0, 1, MIN_ENTRIES - 1, MIN_ENTRIES):
        prior = fit_prior(problem, materials.rows(np.arange(count)))
        errors = prior.standard_error(np.full((1, 3), 0.3))
        assert (errors is not None) == (count == MIN_ENTRIES)
