"""Text of many numbers is that of ``repr``."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from uplift.extras.files.numbers import FEW, LEAST_LARGE, LEAST_PLAIN, number_rows


def plain_rows(values, separator):
    return [separator.join(map(repr, row)) for row in values.tolist()]


@settings(max_examples=20)
@given(st.lists(st.tuples(st.floats(), st.floats()), min_size=1))
def test_any_floats_are_written_as_by_repr(rows):
    values = np.repeat(np.array(rows), FEW, axis=0)
    assert number_rows(values) == plain_rows(values, ",")
    assert number_rows(values[:1]) == plain_rows(values[:1], ",")


def test_magnitudes_are_written_as_by_repr():
    rng = np.random.default_rng(7)
    values = 10 ** rng.uniform(-6, 18, (2000, 3))
    values[:3, 0] = LEAST_PLAIN, np.nextafter(LEAST_PLAIN, 0), LEAST_LARGE
    assert number_rows(values, ", ") == plain_rows(values, ", ")
