"""Values written as TOML are read back by the standard library."""

import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uplift.extras.files.toml import matrix_value, number_value, row_value, text_value

TEXT = st.text(st.characters(exclude_categories=["Cs"]))


def read(value):
    return tomllib.loads(f"key = {value}")["key"]


@given(TEXT)
def test_any_text_round_trips(text):
    assert read(text_value(text)) == text


@given(st.floats(allow_nan=False))
def test_numbers_round_trip_to_nine_digits(value):
    stored = read(number_value(value))
    assert isinstance(stored, float)
    assert stored == pytest.approx(value, rel=5e-9, abs=0)


def test_rows_and_matrices_round_trip():
    values = np.random.default_rng(3).normal(size=(3, 4))
    assert read(row_value(values[0])) == pytest.approx(values[0], rel=5e-9)
    assert np.array(read(matrix_value(values))) == pytest.approx(values, rel=5e-9)
    assert read(row_value([])) == []
