"""Bounds of colours that are known under two lights: linear programs, and laws."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import ATLASES, ROOT
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import in_unit_cube
from uplift.extras.looks.metamer_bounds import bounds
from uplift.extras.looks.photograph_bounds import bounds_of_photographs
from uplift.extras.photographs.answers import prepare
from uplift.extras.photographs.photograph import photograph


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


@pytest.mark.parametrize("name", ["FL11", "HP1"])
def test_a_second_colour_cuts_the_body_and_keeps_the_material(tungsten, pigments, name):
    rgb, others, measured = pigments
    light = observer.light(name)
    whole = bounds(tungsten.cube, rgb, light, divisions=1)
    cut = bounds_of_photographs(tungsten, rgb, others, light, divisions=1)
    assert (cut.share < whole.share).all()
    assert np.median(cut.share / whole.share) < 0.7
    for corners in np.moveaxis(cut.volumes.xyz.reshape(len(rgb), -1, 3), 1, 0):
        assert whole.volumes.excess(corners).max() <= 1e-7
    assert cut.volumes.excess(measured @ light.xyz.T).max() <= 1e-7


def test_the_body_is_a_point_under_a_light_that_is_known(tungsten, pigments):
    rgb, others, measured = pigments
    light = observer.light("A")
    cut = bounds_of_photographs(tungsten, rgb, others, light, divisions=1)
    expected = np.repeat((measured @ light.xyz.T)[:, None], 42, axis=1)
    assert_allclose(cut.volumes.xyz, expected, atol=1e-6)
