"""Errors of materials of families that a cube does not know."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import MACBETH
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit import left_out_families as module
from uplift.fit.base import learn_base
from uplift.fit.families import STAND_IN, Family, shipped_library
from uplift.fit.left_out_families import leave_out_families
from uplift.fit.problem import Problem
from uplift.lookup.errors_under_lights import light_errors
from uplift.models.model import evaluate
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

LIGHTS = tuple(observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3"))
ONES = (1.0,) * 7


@pytest.fixture(scope="module")
def problem(sensor):
    return Problem(sensor, Moments(9), LIGHTS)


def inside(sensor, family):
    rgb = sensor.rgb(family.measured)
    rows = in_unit_cube(rgb)
    return np.clip(rgb[rows], 0, 1), family.measured[rows]


def test_each_family_is_predicted_by_the_base_of_all_others(problem, sensor):
    """The slow way: a table of base spectra for each family, interpolated."""
    families = shipped_library()
    left_out = leave_out_families(problem, families, ONES)
    names = [family.name for family in families if family.name != STAND_IN]
    for number, name in enumerate(names):
        (family,) = [family for family in families if family.name == name]
        rgb, measured = inside(sensor, family)
        base, _ = learn_base(problem, shipped_library([name]))
        start = problem.model.from_storage(base.coefficients(rgb))
        solved = problem.solve(rgb, start, 32).multipliers
        expected = evaluate(problem.model, solved, sensor.wavelengths)
        rows = left_out.family == number
        assert_allclose(left_out.rgb[rows], rgb)
        assert_allclose(left_out.measured[rows], measured, atol=1e-6)
        for light in LIGHTS[1:]:
            apart = delta_e_spectra(light, left_out.predicted[rows], expected)
            assert apart.mean() < 0.1, (name, light.name)


def test_a_base_that_has_learnt_nothing_predicts_all_families_alike(sensor):
    problem = Problem(sensor, Sigmoid(), LIGHTS)
    left_out = leave_out_families(problem, shipped_library(), ())
    cube = uplift.build(dim=8, model="sigmoid")
    assert_allclose(
        left_out.predicted, cube.reflectance(left_out.rgb, mode="refined"), atol=0.02
    )


def test_too_few_families_are_no_evidence(problem):
    families = shipped_library()
    assert leave_out_families(problem, families[:2], ONES[:2]) is None
    assert leave_out_families(problem, (), ()) is None
    assert leave_out_families(problem, (*families[:2], families[-1]), ONES[:3]) is None


def test_large_families_are_thinned_evenly(problem, monkeypatch):
    monkeypatch.setattr(module, "MAX_MATERIALS", 50)
    left_out = leave_out_families(problem, shipped_library(), ONES)
    assert len(left_out.rgb) <= 50 + 6
    assert set(left_out.family) == set(range(6))


def test_families_outside_the_space_are_left_out(problem):
    outside = Family("laser", np.eye(81)[20:60:10], 5.0)
    families = (*shipped_library(), outside)
    left_out = leave_out_families(problem, families, (*ONES, 1.0))
    assert set(left_out.family) == set(range(6))


def test_errors_hold_for_families_that_the_cube_does_not_know(sensor):
    """Pooled over the families, none of which the cube knows that predicts it."""
    within = []
    for family in shipped_library([STAND_IN]):
        cube = uplift.build(dim=8, leave_out=[family.name])
        rgb, measured = inside(sensor, family)
        answers = cube.reflectance(rgb)
        for light in LIGHTS[1:]:
            error = delta_e_spectra(light, answers, measured)[:, None]
            within.append(error <= light_errors(cube.data, light)(rgb))
    shares = np.concatenate(within).mean(axis=0)
    assert shares == pytest.approx([0.68, 0.95], abs=0.04)


def test_a_cube_without_an_atlas_states_errors_that_survive_its_file(tmp_path):
    cube = uplift.build(dim=8)
    cube.save(tmp_path / "cube.uplift")
    again = uplift.load(tmp_path / "cube.uplift")
    rgb = np.random.default_rng(3).random((50, 3))
    for light in (None, "A", "HP1"):
        standard = cube.standard_error(rgb, light)
        assert (standard > 0).all()
        assert (cube.error_bound(rgb, light) > standard).all()
        assert_allclose(again.standard_error(rgb, light), standard, rtol=1e-6)
    assert not cube.unlike_atlas([0.2, 0.2, 0.2])
    assert cube.unlike_atlas([0.0, 0.0, 1.0])


def test_the_atlas_is_the_evidence_where_it_suffices(small_cube):
    assert small_cube.data.families is None


def test_entries_that_are_too_few_leave_the_errors_to_the_families():
    cube = uplift.build(uplift.read_atlas(MACBETH)[:3], dim=8)
    assert cube.data.families is not None
    assert cube.standard_error([0.5, 0.2, 0.1]) > 0
