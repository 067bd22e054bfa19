"""Expected errors of colours under a light, on measured materials."""

from dataclasses import replace

from numpy.testing import assert_allclose

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.extras.export.material_error import material_error
from uplift.lookup.cube import Cube


def test_with_an_atlas_the_errors_are_those_of_left_out_entries(small_cube):
    atlas = small_cube.data.atlas
    errors = delta_e_spectra(light("HP1"), atlas.left_out, atlas.measured)
    expected = material_error(small_cube, "HP1")
    assert expected.like_atlas
    assert expected.count == len(errors)
    assert_allclose(expected.mean, errors.mean())
    assert (errors <= expected.bound).mean() >= 0.9


def test_without_an_atlas_they_are_those_of_unknown_families(plain_cube):
    expected = material_error(plain_cube, "A")
    assert not expected.like_atlas
    assert expected.count > 300
    families = plain_cube.data.families
    errors = delta_e_spectra(light("A"), families.predicted, families.measured)
    assert_allclose(expected.mean, errors.mean())
    known = plain_cube.reflectance(families.rgb)
    assert delta_e_spectra(light("A"), known, families.measured).mean() < expected.mean


def test_a_cube_without_left_out_materials_states_nothing(plain_cube):
    earlier = Cube(replace(plain_cube.data, families=None))
    assert material_error(earlier, "A") is None
