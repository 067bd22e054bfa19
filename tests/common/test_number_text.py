"""Numbers in text."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uplift.common.number_text import parse_float, parse_whole


@given(st.floats())
def test_every_float_is_read_back(value):
    found = parse_float(repr(value))
    assert found == value or (math.isnan(found) and math.isnan(value))


@given(st.integers(-(10**18) + 1, 10**18 - 1))
def test_every_whole_number_is_read_back(value):
    assert parse_whole(str(value)) == parse_whole(f" {value:+} ") == value


@pytest.mark.parametrize(
    "text", ["", " ", "1_000", "١", "１", "²", "0x10", "1,5", "1e", "e5", ".", "--1", "1 2", "1\n2"]
)
def test_other_texts_are_errors(text):
    for parse in (parse_float, parse_whole):
        with pytest.raises(ValueError, match="not a"):
            parse(text)


def test_whole_numbers_of_thousands_of_digits_are_errors():
    with pytest.raises(ValueError, match="not a"):
        parse_whole("9" * 5000)
    assert parse_float("9" * 5000) == math.inf


def test_long_texts_are_read_once():
    """A pattern that tries every way to divide the digits takes minutes."""
    with pytest.raises(ValueError, match="not a"):
        parse_float("9" * 100_000 + ":")
