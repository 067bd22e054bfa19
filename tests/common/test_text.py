"""Text that is safe to show, numbers in text, and CSV."""

import csv
import io
import json
import math
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uplift.common.text import (
    format_value,
    json_escapes,
    parse_float,
    parse_whole,
    printable,
)
from uplift.extras.files.csv import csv_text, plain_cell

ANY_TEXT = st.text(st.characters(exclude_categories=()))
"""Text of any code points, lone surrogates among them."""


@given(ANY_TEXT)
def test_printable_text_has_no_controls_and_can_be_encoded(text):
    shown = printable(text)
    shown.encode()
    categories = {unicodedata.category(character) for character in shown}
    assert not categories & {"Cc", "Cs", "Zl", "Zp"}
    directions = {unicodedata.bidirectional(character) for character in shown}
    assert not directions & {"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI"}


@given(st.dictionaries(ANY_TEXT, ANY_TEXT), st.sampled_from([None, 2]))
def test_escaped_json_has_the_same_values_and_only_printable_lines(values, indent):
    text = json_escapes(json.dumps(values, ensure_ascii=False, indent=indent))
    assert json.loads(text) == values
    assert all(printable(line) == line for line in text.split("\n"))


def test_every_value_has_a_short_text_without_control_characters():
    deep: list[object] = []
    for _ in range(100_000):
        deep = [deep]
    for value in ("\x1b]0;title\x07", "\ud800", "\n", 16**5000, deep, "a" * 100):
        text = format_value(value)
        assert text.isprintable()
        assert len(text.encode()) <= 43


@given(st.floats(), st.integers(-(10**18) + 1, 10**18 - 1))
def test_every_number_is_read_back(value, whole):
    found = parse_float(repr(value))
    assert found == value or (math.isnan(found) and math.isnan(value))
    assert parse_whole(str(whole)) == parse_whole(f" {whole:+} ") == whole


@pytest.mark.parametrize(
    "text",
    [
        "",
        "1_000",
        "١",
        "²",
        "0x10",
        "1,5",
        "1e",
        "e5",
        ".",
        "--1",
        "1\n2",
        "9" * 10_000 + ":",
    ],
)
def test_other_texts_are_errors(text):
    for parse in (parse_float, parse_whole):
        with pytest.raises(ValueError, match="not a"):
            parse(text)


def test_cells_survive_a_round_trip():
    rows = [["plain", 'quote "', "comma, semicolon;"], ["line\nbreak", "", "ü"]]
    text = csv_text(["a", "b", "c"], rows)
    assert list(csv.reader(io.StringIO(text, newline=""))) == [["a", "b", "c"], *rows]
    quoted = csv_text(["name", 400.0], [["1", 0.5]], quote_text=True)
    assert quoted == '"name",400.0\n"1",0.5\n'


@pytest.mark.parametrize(
    "name",
    ["=1+2", "+cmd|' /C calc'!A0", "-x", "@SUM(A1)", "\t=1", "'=1", "''-x", "＝1"],
)
def test_formulas_are_neutralised_and_come_back(name):
    (cell,) = next(csv.reader(io.StringIO(csv_text([name], []), newline="")))
    assert cell == f"'{name}"
    assert plain_cell(cell) == name


@pytest.mark.parametrize(
    "cell", ["-1.5", "+3e-5", -2.5, "a-b", "it's", "'quoted'", None, ""]
)
def test_numbers_and_other_text_stay(cell):
    text = csv_text(["x", cell], [])
    assert "'" not in text.replace(str(cell), "")
    assert plain_cell(str(cell)) == str(cell)
