"""One CSV file holds a chart, whole or not at all."""

from __future__ import annotations

import pytest

from uplift.common.errors import ChartFileError
from uplift.lab.chart.table import State, chart_csv, parse_chart, read_chart


def test_what_is_written_is_read(row_of, chart_of, tmp_path):
    chart = chart_of(
        row_of("quick, or 'not'", 12.3456, 1e-7, note="a note\nof two lines"),
        row_of("broken", 1, 1, state=State.BROKEN, why="NaN", numbers={}),
    )
    (tmp_path / "chart.csv").write_text(chart_csv(chart), encoding="utf-8")
    again = read_chart(tmp_path / "chart.csv")
    assert again.facts == chart.facts
    assert chart_csv(again) == chart_csv(chart)
    first, second = again.rows
    assert first.numbers == pytest.approx(chart.rows[0].numbers, rel=1e-5)
    assert (first.method, first.note) == ("quick, or 'not'", "a note\nof two lines")
    assert (second.state, second.why, second.numbers) == (State.BROKEN, "NaN", {})


@pytest.mark.parametrize(
    ("spoil", "problem"),
    [
        (lambda text: "", "is no chart's table"),
        (lambda text: "name,r,g,b\nred,1,0,0\n", "is no chart's table"),
        (lambda text: text.splitlines()[0] + "\n", "holds no methods"),
        (lambda text: text.replace("measured", "excellent"), "is broken"),
        (lambda text: text.replace("12.5", "fast"), "is broken"),
        (lambda text: text.replace("12.5", "nan"), "has a number that is none"),
        (lambda text: text.rstrip()[:-30], "is broken"),
        (lambda text: text.rstrip() + ",one,more\n", "is broken"),
    ],
)
def test_a_spoilt_table_is_refused(row_of, chart_of, spoil, problem):
    text = chart_csv(chart_of(row_of("one", 12.5, 1)))
    assert parse_chart(text, "chart.csv").rows
    with pytest.raises(ChartFileError, match=f"chart.csv: .*{problem}.*; name the CSV file"):
        parse_chart(spoil(text), "chart.csv")


def test_a_file_that_is_not_there_is_refused(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(ChartFileError, match="cannot be read"):
            read_chart(path)
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ChartFileError, match="cannot be read"):
        read_chart(tmp_path / "bytes.csv")
