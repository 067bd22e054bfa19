"""Tables written as TOML are read back by the standard library."""

import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uplift.extras.files.toml import toml_text


def again(value):
    return tomllib.loads(toml_text({"some_key": value}))["some-key"]


@settings(max_examples=50)
@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_any_text_round_trips(text):
    assert again([text]) == [text]


@settings(max_examples=20)
@given(st.floats(allow_nan=False))
def test_numbers_round_trip_to_nine_digits(value):
    stored = again(value)
    assert isinstance(stored, float)
    assert stored == pytest.approx(value, rel=5e-9, abs=0)


@pytest.mark.parametrize(
    "value", [3, True, [], {"a": 1, "b": ["c"]}, [{"a": 1}, {"a": 2}]]
)
def test_other_values_and_tables_round_trip(value):
    assert again(value) == value


def test_arrays_round_trip():
    values = np.random.default_rng(3).normal(size=(3, 4))
    assert np.array(again(values)) == pytest.approx(values, rel=5e-9)


def test_values_come_before_tables_and_none_is_left_out():
    text = toml_text({"a": {"b": None}, "c": None, "d": 1.0, "e": [{}]})
    assert text == "d = 1.0\n\n[a]\n\n[[e]]"
