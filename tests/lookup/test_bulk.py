"""Bulk queries agree with numpy, for all shapes, sizes and numbers of threads."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.cube.hand_made import hand_made
from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.lattice.lattice import Lattice
from uplift.lookup import bulk
from uplift.lookup.cube import Cube

AT = np.linspace(380, 780, 9)
CUBES = ["small_cube", "plain_cube", "small_sigmoid_cube"]


@pytest.fixture(params=CUBES)
def cube(request):
    return request.getfixturevalue(request.param)


def colours(data, count=3000):
    """Random colours, all nodes, and colours in, around and on the faces of entry
    boxes.
    """
    rng = np.random.default_rng(5)
    low, high = data.entry_boxes.faces
    boxes = [
        data.atlas.rgb,
        low,
        high,
        *(low + share * (high - low) for share in rng.random((20, len(low), 3))),
        *(
            np.where(rng.random(low.shape) < 0.5, low, middle)
            for middle in [data.atlas.rgb] * 5
        ),
        *(data.atlas.rgb + rng.normal(0, 1e-9, low.shape) for _ in range(3)),
    ]
    return np.clip(
        np.concatenate([rng.random((count, 3)), data.lattice.points[::7], *boxes]), 0, 1
    )


def test_spectra_are_those_of_numpy(cube):
    rgb = colours(cube.data)
    found = bulk.spectra(cube, AT)(rgb)
    assert found.dtype == np.float32
    assert found.min() >= 0
    assert found.max() <= 1
    assert_allclose(found, cube.reflectance(rgb, AT), rtol=0, atol=1e-6)


@pytest.mark.parametrize("count", [None, "entries"])
def test_coefficients_are_those_of_numpy(cube, count):
    rgb = colours(cube.data)
    count = None if count is None else cube.entry_coefficient_count
    expected = cube.coefficients(rgb, count)
    # A sigmoid's coefficients run into hundreds, and are steep in the colour.
    found = bulk.coefficients(cube, count)(rgb)
    assert_allclose(found, expected, rtol=0, atol=2e-6 * np.abs(expected).max())


def test_nodes_closer_than_bins_are_distinguished():
    data = hand_made(
        lattice=Lattice(np.array([0.0, 1e-5, 2e-5, 1.0])),
        distance=np.zeros(64, np.float32),
    )
    rng = np.random.default_rng(1)
    rgb = np.concatenate(
        [rng.random((500, 3)), 3e-5 * rng.random((500, 3)), data.lattice.points]
    )
    found = bulk.coefficients(Cube(data))(rgb)
    assert_allclose(found, Cube(data).coefficients(rgb), rtol=0, atol=1e-5)


def test_results_do_not_depend_on_chunks_and_threads(small_cube, monkeypatch):
    rgb = colours(small_cube.data)
    whole = bulk.spectra(small_cube, AT, threads=1)(rgb)
    monkeypatch.setattr("uplift.lookup.bulk.CHUNKS", (256, 64))
    for threads in (1, 2, 5):
        again = bulk.spectra(small_cube, AT, threads=threads)(rgb)
        assert_allclose(again, whole, rtol=0, atol=1e-6)


def test_invalid_wavelengths_counts_and_threads_are_refused(small_cube):
    with raises(OptionError, "option"):
        bulk.spectra(small_cube, [0])
    for options in ({"count": 12}, {"threads": 0}):
        with raises(OptionError, "option"):
            bulk.coefficients(small_cube, **options)
