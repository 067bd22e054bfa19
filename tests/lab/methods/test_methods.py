"""Methods of the chart against reference implementations."""

import numpy as np
import pytest
from colour.recovery import RGB_to_sd_Mallett2019, RGB_to_sd_Smits1999
from numpy.testing import assert_allclose

from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.lab.chart.selection import select_methods
from uplift.lab.methods.cubes import built_cube
from uplift.lab.runner import divided

SENSOR = observer.sensor()
AT = SENSOR.wavelengths
RANDOM = np.random.default_rng(4).random((20, 3))
COLOURS = np.concatenate([RANDOM, np.eye(3), [[0, 0, 0], [1, 1, 1]]])


@pytest.fixture(scope="module")
def task():
    """Half of the smallest atlas."""
    return next(divided(read_atlas("tcs"), ("tcs",), SENSOR))


def prepared(name, task):
    (method,) = select_methods((name,))
    return method.prepare(task).uplift


@pytest.mark.parametrize(
    ("name", "theirs"),
    [("smits1999", RGB_to_sd_Smits1999), ("mallett2019", RGB_to_sd_Mallett2019)],
)
def test_smits_and_mallett_match_colour_science(task, name, theirs):
    found = prepared(name, task)(COLOURS, AT)
    expected = [np.interp(AT, sd.wavelengths, sd.values) for sd in map(theirs, COLOURS)]
    assert_allclose(found, expected, atol=1e-12)


def test_jakob_has_the_colour(task):
    found = prepared("jakob2019-direct", task)(RANDOM[:2], AT)
    assert_allclose(SENSOR.rgb(found), RANDOM[:2], atol=2e-3)


@pytest.mark.parametrize(
    ("double", "single"),
    [
        ("smits1999", "smits1999-float32"),
        ("moments9-8-spectra", "moments9-8-bulk"),
        ("sigmoid-32-moments", "sigmoid-32-moments-float32"),
    ],
)
def test_float32_and_bulk_give_the_same_spectra(task, double, single):
    found = prepared(single, task)(COLOURS.astype(np.float32), AT)
    assert found.dtype == np.float32
    assert_allclose(found, prepared(double, task)(COLOURS, AT), atol=2e-6)


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_cubes_do_not_know_the_families_of_a_task(task):
    cube, *_ = built_cube(task, atlas=True, dim=8, coefficients=3)
    assert cube is built_cube(task, atlas=True, dim=8, coefficients=3)[0]
    assert cube.atlas_names == task.known.names
    assert tuple(cube.data.provenance["options"]["leave_out"]) == ("tcs",)
