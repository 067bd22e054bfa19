"""Designed reflectances of looks: exact colours, wishes of real materials met, and the
nearest colour where none is.
"""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import linprog

import uplift
from tests.conftest import MACBETH
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000_weights, lab, lab_jacobian
from uplift.colorimetry.sensor import in_unit_cube
from uplift.extras.looks.design import (
    LookGoal,
    design_reflectance,
    fit_designs,
    join_entries,
)
from uplift.extras.looks.targets import prior_with_looks
from uplift.fit.entries import fit_entries
from uplift.fit.prior import fit_prior
from uplift.fit.problem import Problem
from uplift.models.moments import Moments

TOLERANCE = 1e-6


def goal_of(sensor, lights, reflectance, rgb=None):
    """The colours of a reflectance, perhaps with the RGB of another one."""
    return LookGoal(
        sensor.rgb(reflectance) if rgb is None else rgb,
        tuple(lights),
        np.stack([light.xyz @ reflectance for light in lights]),
    )


@pytest.fixture(scope="module")
def materials(sensor):
    """Measured reflectances in gamut, and what a cube without an atlas answers to their
    colours.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        measured = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    measured = measured[in_unit_cube(sensor.rgb(measured))]
    return measured, uplift.load().reflectance(np.clip(sensor.rgb(measured), 0, 1))


def test_nearest_colour_is_that_of_a_linear_program(sensor, materials):
    """No metamer lies farther towards the wish, in the metric of ΔE00 at the wish."""
    measured, expected = (spectra[7] for spectra in materials)  # purplish blue
    light = observer.light("A")
    other = np.clip(measured * np.linspace(0.2, 2.5, 81), 0, 1)
    goal = goal_of(sensor, [light], other, sensor.rgb(expected))
    found = design_reflectance(sensor, goal, expected)
    assert goal.delta_e(found)[0] > 1
    assert_allclose(sensor.rgb(found), goal.rgb, atol=1e-4)
    xyz = goal.colours(found)[0]
    wished = lab(goal.xyz[0], light.white)
    weights = delta_e_2000_weights(wished)
    apart = weights @ (wished - lab(xyz, light.white))
    towards = apart @ (weights @ lab_jacobian(xyz, light.white) @ light.xyz)
    best = linprog(-towards, A_eq=sensor.matrix, b_eq=sensor.rgb(found), bounds=(0, 1))
    assert best.status == 0
    length = np.linalg.norm(apart)
    assert (-best.fun - towards @ found) / length < 0.02 * length
    # the test can fail: the expected spectrum is not the nearest
    assert (-best.fun - towards @ expected) / length > 0.2 * length


def test_the_prior_follows_looks_nearby_only(sensor, materials):
    measured, expected = materials
    light = observer.light("FL11")
    problem = Problem(sensor, Moments(9), (light,), light)
    known = measured[:6]
    entries = fit_entries(problem, known, np.clip(sensor.rgb(known), 0, 1))
    plain = fit_prior(problem, entries)
    rgb = sensor.rgb(expected[7])
    goal = goal_of(sensor, [light], 0.9 * expected[7] + 0.05, rgb)
    design = design_reflectance(sensor, goal, expected[7])
    look = fit_designs(problem, [goal], design[None])
    changed = prior_with_looks(plain, join_entries(entries, look), 1)
    near, far = (
        np.abs(changed(each) - plain(each)).max()
        for each in (rgb[None] * 1.01, np.array([[0.9, 0.9, 0.2]]))
    )
    assert near > 10 * far
