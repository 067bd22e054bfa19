"""CSV files of charts."""

from __future__ import annotations

import pytest

from tests.helpers import raises
from uplift.common.errors import ChartFileError
from uplift.lab.chart.table import State, chart_csv, parse_chart, read_chart


def test_csv_round_trip(row_of, chart_of, tmp_path):
    chart = chart_of(
        row_of("quick, or 'not'", 12.3456, 1e-7, note="a note\nof two lines"),
        row_of("broken", 1, 1, state=State.BROKEN, why="NaN", numbers={}),
    )
    (tmp_path / "chart.csv").write_text(chart_csv(chart), encoding="utf-8")
    again = read_chart(tmp_path / "chart.csv")
    assert again.facts == chart.facts
    assert chart_csv(again) == chart_csv(chart)
    first, second = again.results
    assert first.numbers == pytest.approx(chart.results[0].numbers, rel=1e-5)
    assert (first.method, first.note) == ("quick, or 'not'", "a note\nof two lines")
    assert (second.state, second.why, second.numbers) == (State.BROKEN, "NaN", {})


@pytest.mark.parametrize(
    ("spoil", "code"),
    [
        (lambda text: "", "not-a-chart"),
        (lambda text: "name,r,g,b\nred,1,0,0\n", "not-a-chart"),
        (lambda text: text.splitlines()[0] + "\n", "chart-without-methods"),
        (lambda text: text.replace("measured", "excellent"), "invalid-chart"),
        (lambda text: text.replace("12.5", "fast"), "invalid-chart"),
        (lambda text: text.replace("12.5", "nan"), "invalid-chart"),
        (lambda text: text.replace("unseen_spectra", "seen_spectra"), "invalid-chart"),
        (lambda text: text.rstrip()[:-30], "invalid-chart"),
        (lambda text: text.rstrip() + ",one,more\n", "invalid-chart"),
    ],
)
def test_invalid_table_is_an_error(row_of, chart_of, spoil, code):
    text = chart_csv(chart_of(row_of("one", 12.5, 1)))
    assert parse_chart(text, "chart.csv").results
    with raises(ChartFileError, code) as caught:
        parse_chart(spoil(text), "chart.csv")
    assert caught.value.path == "chart.csv"


def test_unreadable_file_is_an_error(tmp_path):
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00")
    for name, code in (
        ("none.csv", "file-not-found"),
        ("", "not-a-regular-file"),
        ("bytes.csv", "file-unreadable"),
    ):
        with raises(ChartFileError, code):
            read_chart(tmp_path / name)
