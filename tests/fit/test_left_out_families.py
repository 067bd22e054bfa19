"""Errors of materials of families that a cube does not know."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import MACBETH
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit import left_out_families as module
from uplift.fit.families import STAND_IN, Family, shipped_library
from uplift.fit.left_out_families import leave_out_families
from uplift.lookup.errors_under_lights import light_errors

ONES = (1.0,) * 7


def test_too_few_families_are_no_evidence(problem):
    for families in ((), (*shipped_library()[:2], shipped_library()[-1])):
        assert leave_out_families(problem, families, ONES[: len(families)]) is None


def test_families_are_thinned_and_those_outside_the_space_are_left_out(
    problem, monkeypatch
):
    monkeypatch.setattr(module, "MAX_MATERIALS", 50)
    outside = Family("laser", np.eye(81)[20:60:10], 5.0)
    families = (*shipped_library(), outside)
    left_out = leave_out_families(problem, families, (*ONES, 1.0))
    assert len(left_out.rgb) <= 50 + 6
    assert set(left_out.family) == set(range(6))


def test_errors_hold_for_families_that_the_cube_does_not_know(problem, sensor):
    """Pooled over the families, none of which the cube knows that predicts it."""
    within = []
    for family in shipped_library([STAND_IN]):
        cube = uplift.build(dim=8, leave_out=[family.name])
        measured = family.measured[in_unit_cube(sensor.rgb(family.measured))]
        rgb = np.clip(sensor.rgb(measured), 0, 1)
        answers = cube.reflectance(rgb)
        for light in problem.lights[1:]:
            error = delta_e_spectra(light, answers, measured)[:, None]
            within.append(error <= light_errors(cube.data, light)(rgb))
    shares = np.concatenate(within).mean(axis=0)
    assert shares == pytest.approx([0.68, 0.95], abs=0.04)


def test_families_state_the_errors_where_the_atlas_does_not_suffice(
    small_cube, tmp_path
):
    assert small_cube.data.families is None
    rgb = np.random.default_rng(3).random((50, 3))
    for atlas in (None, uplift.read_atlas(MACBETH)[:3]):
        cube = uplift.build(atlas, dim=8)
        assert cube.data.families is not None
        cube.save(tmp_path / "cube.uplift", force=True)
        again = uplift.load(tmp_path / "cube.uplift")
        for light in (None, "A", "HP1"):
            standard = cube.standard_error(rgb, light)
            assert (standard > 0).all()
            assert (cube.error_bound(rgb, light) > standard).all()
            assert_allclose(again.standard_error(rgb, light), standard, rtol=1e-6)
