"""Every RGB space by name: small cubes are built, stored, read, looked up
and exported.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.fuzz.builds import little_work
from uplift.colorimetry import tables
from uplift.cube.file import digest

SPACES = sorted(
    {tables.stated_name("RGB space", name) for name in tables.names("RGB space")}
)
COLOURS = np.random.default_rng(0).random((24, 3), dtype=np.float32).astype(float)
DEEP = 1e-4  # inside the solid, so that spectra are not steps


@pytest.fixture(scope="module", autouse=True)
def _little_work():
    with little_work():
        yield


@pytest.mark.parametrize("space", SPACES)
def test_a_cube_of_the_space_works(space, tmp_path):
    cube = uplift.build(dim=2, space=space, model="sigmoid", prior="smooth")
    cube.save(tmp_path / "cube.uplift")
    assert digest(uplift.load(tmp_path / "cube.uplift").data) == digest(cube.data)
    sensor = cube.data.sensor
    rgb = COLOURS[cube.data.solid.signed_distance(COLOURS) < -DEEP]
    assert len(rgb)
    assert_allclose(sensor.rgb(cube.reflectance(rgb)), rgb, rtol=0, atol=1e-5)
    assert_allclose(cube.decode(cube.encode(rgb)), rgb, rtol=0, atol=1e-12)
