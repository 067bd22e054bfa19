"""Tables of pages from long rows of measurements."""

from tools.render_docs import average, pivot

ROWS = [
    {"set": "cards", "method": "cube", "light": "A", "n": 3, "mean": 1.0, "p95": 2.0},
    {"set": "cards", "method": "cube", "light": "F", "n": 3, "mean": 3.0, "p95": 4.0},
    {"set": "cards", "method": "table", "light": "F", "n": 3, "mean": 5.0, "p95": 6.0},
]


def test_rows_become_columns_by_the_values_of_one_column():
    assert pivot(ROWS, "set method", "light", "{mean:.1f} / {p95:.1f}") == (
        "| set | method | A | F |\n| --- | --- | --- | --- |\n"
        "| cards | cube | 1.0 / 2.0 | 3.0 / 4.0 |\n| cards | table |  | 5.0 / 6.0 |\n"
    )


def test_floats_are_averaged_over_rows_that_agree():
    assert average(ROWS, "method") == [
        {"method": "cube", "mean": 2.0, "p95": 3.0},
        {"method": "table", "mean": 5.0, "p95": 6.0},
    ]
