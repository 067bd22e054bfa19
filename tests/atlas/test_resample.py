"""Resampling to a grid: averages over bands of fine data, and clips of the file's own
values.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import PchipInterpolator

from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.resampling import on_grid, resample

GRID = np.arange(380.0, 781.0, 5.0)


def one(nm, values):
    return Atlas((Entry("e", nm, values),))


@pytest.mark.parametrize("step", [0.5, 1.0, 2.0])
def test_fine_data_are_averaged_over_bands(step):
    nm = np.arange(370.0, 790.1, step)
    values = np.random.default_rng(0).uniform(0.2, 0.8, len(nm))
    found = on_grid(one(nm, values), GRID)[0]
    curve = PchipInterpolator(nm, values)
    dense = np.linspace(-2.5, 2.5, 4001)[:-1] + 2.5 / 4000
    assert_allclose(found, curve(GRID[:, None] + dense).mean(axis=1), atol=1e-6)


def test_bands_beyond_the_data_keep_the_last_value():
    nm = np.arange(400.0, 700.1)
    found = on_grid(one(nm, np.linspace(0.2, 0.8, len(nm))), GRID)[0]
    assert_allclose(found[[0, 3]], 0.2, atol=1e-12)
    assert_allclose(found[[-1, -15]], 0.8, atol=1e-12)


@pytest.mark.parametrize(
    "grid", [[450.0, 550.0, 650.0], [380.0, 400.0, 550.0, 700.0], [500.0, 550.0]]
)
def test_wavelengths_that_are_no_sampling_are_points(grid):
    nm = np.arange(380.0, 781.0)
    values = np.random.default_rng(2).uniform(0, 1, len(nm))
    assert_array_equal(
        on_grid(one(nm, values), grid)[0], values[np.array(grid, int) - 380]
    )


def test_clips_are_those_of_the_file():
    nm = np.arange(380.0, 781.0)
    values = np.full(len(nm), 0.5)
    values[12] = -0.014  # between samples of the grid
    (clip,) = resample(one(nm, values), GRID).clips
    assert (clip.value, clip.wavelength) == (-0.014, 392.0)
