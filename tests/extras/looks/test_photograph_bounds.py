"""Bounds of colours that are known under two lights: linear programs, and laws."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import linprog

import uplift
from tests.conftest import ATLASES, ROOT
from tests.helpers import raises
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import delta_e_2000, in_unit_cube, lab, observer
from uplift.common.errors import ColourError, OptionError
from uplift.extras.looks.extreme_spectra import extreme_spectra
from uplift.extras.looks.metamer_bounds import bounds
from uplift.extras.looks.photograph_bounds import bounds_of_photographs
from uplift.extras.photographs import photograph, prepare

ROUNDING = 1e-9


@pytest.fixture(scope="module")
def tungsten():
    cube = uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")
    return prepare(cube, [photograph(cube.data.sensor, "A")])


@pytest.fixture(scope="module")
def pigments(tungsten):
    """Linear RGB under both lights, and reflectances of measured paints."""
    sensor = tungsten.cube.data.sensor
    atlas = read_atlas(ATLASES / "pmc.txt")
    measured = resample(atlas, sensor.wavelengths).values
    inside = measured[in_unit_cube(sensor.rgb(measured))][::3]
    return sensor.rgb(inside), inside @ tungsten.matrix.T, inside


@pytest.mark.parametrize("second", ["A", "LED-B3", "D50", "FL11"])
def test_extremes_with_six_numbers_are_those_of_linear_programs(sensor, second):
    random = np.random.default_rng(4)
    matrix = np.concatenate([sensor.matrix, photograph(sensor, second).matrix])
    smooth = np.cumsum(random.normal(scale=0.3, size=(8, 81)), axis=1)
    values = 1 / (1 + np.exp(-smooth)) @ matrix.T
    response = random.normal(size=(8, 3)) @ observer.light("HP1").xyz
    extremes = extreme_spectra(matrix, values, response)
    assert extremes.solved.all()
    assert_allclose(extremes.reflectance @ matrix.T, values, atol=1e-8)
    for row in range(8):
        best = linprog(
            -response[row], A_eq=matrix, b_eq=values[row], bounds=(0, 1), method="highs"
        )
        largest = response[row] @ extremes.reflectance[row]
        assert largest == pytest.approx(-best.fun, abs=1e-8)


@pytest.mark.parametrize("name", ["FL11", "HP1"])
def test_a_second_colour_cuts_the_body_and_keeps_the_material(tungsten, pigments, name):
    rgb, others, measured = pigments
    light = observer.light(name)
    whole = bounds(tungsten.cube, rgb, light, divisions=1)
    cut = bounds_of_photographs(tungsten, rgb, others, light, divisions=1)
    assert (cut.share < whole.share).all()
    assert np.median(cut.share / whole.share) < 0.7
    inside = cut.volumes.xyz.reshape(len(rgb), -1, 3)
    for point in range(inside.shape[1]):
        assert whole.volumes.excess(inside[:, point]).max() <= 1e-7
    assert cut.volumes.excess(measured @ light.xyz.T).max() <= 1e-7


def test_the_body_is_a_point_under_a_light_that_is_known(tungsten, pigments):
    rgb, others, measured = pigments
    light = observer.light("A")
    cut = bounds_of_photographs(tungsten, rgb, others, light, divisions=1)
    expected = np.repeat((measured @ light.xyz.T)[:, None], 42, axis=1)
    assert_allclose(cut.volumes.xyz, expected, atol=1e-6)


def test_the_largest_difference_is_one_that_linear_programs_reach(tungsten, pigments):
    """No extreme in a random direction differs by more."""
    rgb, others, _ = pigments
    light = observer.light("FL11")
    matrix = np.concatenate([tungsten.cube.data.sensor.matrix, tungsten.matrix])
    cut = bounds_of_photographs(tungsten, rgb[:2], others[:2], light)
    random = np.random.default_rng(0)
    for row in range(2):
        values = np.concatenate([rgb[row], others[row]])
        reference = lab(cut.xyz[row], light.white)
        for direction in random.normal(size=(40, 3)):
            response = direction @ light.xyz
            best = linprog(
                -response, A_eq=matrix, b_eq=values, bounds=(0, 1), method="highs"
            )
            away = delta_e_2000(lab(light.xyz @ best.x, light.white), reference)
            assert away <= cut.largest.delta_e_2000[row] + 1e-3


def test_likely_regions_shrink(tungsten, pigments):
    rgb, others, _ = pigments
    light = observer.light("HP1")
    whole = bounds(tungsten.cube, rgb, light, divisions=0)
    cut = bounds_of_photographs(tungsten, rgb, others, light, divisions=0)
    before = np.linalg.det(whole.covariance[:, 1:, 1:])
    after = np.linalg.det(cut.covariance[:, 1:, 1:])
    assert np.median(after / before) < 0.5


def test_colours_that_no_reflectance_has_are_refused(tungsten):
    rgb = np.array([[0.2, 0.2, 0.2]])
    light = observer.light("FL11")
    with raises(ColourError, "colour-unrealisable"):
        bounds_of_photographs(tungsten, rgb, np.array([[0.9, 0.05, 0.05]]), light)
    with raises(OptionError):
        bounds_of_photographs(tungsten, rgb, np.array([[0.2, 0.2]]), light)
