"""Expected errors of colours under a light, on measured materials."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from uplift.colorimetry import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.extras.export import material_error
from uplift.extras.export.material_error import left_out_families
from uplift.fit import shipped_library


@pytest.fixture(scope="module")
def unaware():
    """A cube that knows no family."""
    names = [family.name for family in shipped_library()]
    return uplift.build(dim=8, leave_out=names)


def test_with_an_atlas_the_errors_are_those_of_left_out_entries(small_cube):
    atlas = small_cube.data.atlas
    errors = delta_e_spectra(light("HP1"), atlas.left_out, atlas.measured)
    expected = material_error(small_cube, "HP1")
    assert expected.like_atlas
    assert expected.count == len(errors)
    assert_allclose(expected.mean, errors.mean())
    assert (errors <= expected.bound).mean() >= 0.9


def test_families_that_a_cube_does_not_know_are_predicted_by_the_cube(unaware):
    measured, predicted = left_out_families(unaware)
    sensor = unaware.data.sensor
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    assert_allclose(predicted, unaware.reflectance(rgb), atol=1e-12)
    assert len(measured) > 300


def test_families_that_a_cube_knows_are_predicted_without_them(unaware):
    """As well as by a cube that knows the others, and worse than by one that knows
    them all.
    """
    cube = uplift.build(dim=8)
    measured, predicted = left_out_families(cube)
    rgb = np.clip(cube.data.sensor.rgb(measured), 0, 1)
    lit = light("A")
    expected = material_error(cube, "A")
    assert not expected.like_atlas
    assert_allclose(expected.mean, delta_e_spectra(lit, predicted, measured).mean())
    known = delta_e_spectra(lit, cube.reflectance(rgb), measured).mean()
    assert known < expected.mean < material_error(unaware, "A").mean


def test_under_the_light_of_the_cube_colours_are_right(unaware):
    assert material_error(unaware, "D65").bound < 0.05
