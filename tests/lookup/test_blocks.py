"""Large queries: results do not depend on blocks, tables, threads and types."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.lookup import MODES
from uplift.lookup.blocks import BLOCK, blockwise
from uplift.lookup.cube import TABULATED

AT = [450.0, 550.0, 650.0]


def random_colours(count, seed=0):
    return np.random.default_rng(seed).random((count, 3))


@pytest.mark.parametrize("mode", MODES)
def test_reflectances_do_not_depend_on_threads(small_cube, mode):
    rgb = random_colours(2 * BLOCK + 5)
    alone = small_cube.reflectance(rgb, AT, mode)
    np.testing.assert_array_equal(small_cube.reflectance(rgb, AT, mode, threads=3), alone)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("count", [3, 1000])
def test_float32_agrees_with_float64(small_cube, mode, count):
    rgb = random_colours(count)
    found = small_cube.reflectance(rgb, AT, mode, dtype=np.float32)
    assert found.dtype == np.float32
    assert found.min() >= 0
    assert found.max() <= 1
    np.testing.assert_allclose(found, small_cube.reflectance(rgb, AT, mode), rtol=0, atol=1e-6)


@pytest.mark.parametrize("mode", TABULATED)
def test_a_table_of_all_points_gives_equal_spectra(small_cube, monkeypatch, mode):
    entries = small_cube.data.atlas.rgb
    rgb = np.concatenate([random_colours(600), entries, entries + 1e-3])
    assert len(rgb) >= small_cube.data.lattice.size
    from_table = small_cube.reflectance(rgb, AT, mode)
    monkeypatch.setattr("uplift.lookup.cube.MAX_TABLE_BYTES", 0)
    np.testing.assert_allclose(small_cube.reflectance(rgb, AT, mode), from_table, rtol=0, atol=1e-14)


@pytest.mark.parametrize("dtype", [np.float16, int, "complex128", object, 3])
def test_unsupported_types_are_refused(small_cube, dtype):
    with raises(OptionError, "option"):
        small_cube.reflectance([0.5, 0.5, 0.5], dtype=dtype)
    with raises(OptionError, "option"):
        small_cube.coefficients([0.5, 0.5, 0.5], dtype=dtype)


@pytest.mark.parametrize("threads", [0, -1, 1.0, "2", None, True])
def test_invalid_numbers_of_threads_are_refused(small_cube, threads):
    with raises(OptionError, "option"):
        small_cube.reflectance([0.5, 0.5, 0.5], threads=threads)


def test_errors_in_threads_are_raised():
    def fail(rows):
        raise ArithmeticError(len(rows))

    with pytest.raises(ArithmeticError, match="4"):
        blockwise(fail, np.zeros((8, 3)), 1, threads=2, block=4)
