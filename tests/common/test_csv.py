"""CSV text."""

from __future__ import annotations

import csv
import io

import pytest

from uplift.common.csv import csv_text, plain_cell


def test_cells_survive_a_round_trip():
    rows = [["plain", 'quote "', "comma, semicolon;"], ["line\nbreak", "", "ü"]]
    text = csv_text(["a", "b", "c"], rows)
    assert list(csv.reader(io.StringIO(text, newline=""))) == [["a", "b", "c"], *rows]


def test_numbers_keep_all_digits_and_lines_end_with_lf():
    assert csv_text(["x"], [[0.1 + 0.2], [1 / 3]]) == f"x\n{0.1 + 0.2!r}\n{1 / 3!r}\n"


def test_text_can_be_quoted():
    assert csv_text(["name", 400.0], [["1", 0.5]], quote_text=True) == '"name",400.0\n"1",0.5\n'


@pytest.mark.parametrize("name", ["=1+2", "+cmd|' /C calc'!A0", "-x", "@SUM(A1)", "\t=1", "'=1", "''-x", "＝1"])
def test_formulas_are_neutralised_and_come_back(name):
    (cell,) = next(csv.reader(io.StringIO(csv_text([name], []), newline="")))
    assert cell == f"'{name}"
    assert plain_cell(cell) == name


@pytest.mark.parametrize("cell", ["-1.5", "+3e-5", -2.5, "a-b", "it's", "'quoted'", None, ""])
def test_numbers_and_other_text_stay(cell):
    text = csv_text(["x", cell], [])
    assert "'" not in text.replace(str(cell), "")
    assert plain_cell(str(cell)) == str(cell)
