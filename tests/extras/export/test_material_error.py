"""Expected errors of colours under a light, on measured materials."""

from dataclasses import replace

import pytest
from numpy.testing import assert_allclose

import uplift
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.extras.export.material_error import material_error
from uplift.lookup.cube import Cube


@pytest.fixture(scope="module")
def unaware():
    """A cube without an atlas."""
    return uplift.build(dim=16)


def test_with_an_atlas_the_errors_are_those_of_left_out_entries(small_cube):
    atlas = small_cube.data.atlas
    errors = delta_e_spectra(light("HP1"), atlas.left_out, atlas.measured)
    expected = material_error(small_cube, "HP1")
    assert expected.like_atlas
    assert expected.count == len(errors)
    assert_allclose(expected.mean, errors.mean())
    assert (errors <= expected.bound).mean() >= 0.9


def test_without_an_atlas_they_are_those_of_unknown_families(unaware):
    expected = material_error(unaware, "A")
    assert not expected.like_atlas
    assert expected.count > 300
    families = unaware.data.families
    errors = delta_e_spectra(light("A"), families.predicted, families.measured)
    assert_allclose(expected.mean, errors.mean())
    known = unaware.reflectance(families.rgb)
    assert delta_e_spectra(light("A"), known, families.measured).mean() < expected.mean


def test_a_cube_without_left_out_materials_states_nothing(unaware):
    earlier = Cube(replace(unaware.data, families=None))
    assert material_error(earlier, "A") is None
