"""Text of many numbers is that of ``repr``."""

import numpy as np
import pytest

from uplift.extras.files.numbers import LEAST_LARGE, LEAST_PLAIN, number_rows


@pytest.mark.parametrize("count", [100, 2000])
def test_magnitudes_are_written_as_by_repr(count):
    values = 10 ** np.random.default_rng(7).uniform(-6, 18, (count, 3))
    values[:3, 0] = LEAST_PLAIN, np.nextafter(LEAST_PLAIN, 0), LEAST_LARGE
    values[:3, 1] = np.nan, -np.inf, -0.0
    values[:3, 2] = 5e-324, -1, 0.1
    expected = [", ".join(map(repr, row)) for row in values.tolist()]
    assert number_rows(values, ", ") == expected
