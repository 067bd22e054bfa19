"""Tables in narrow windows: no line is longer than the window, and no number is lost."""

from __future__ import annotations

import io
import json
from collections import Counter

import pytest
from rich.cells import cell_len
from rich.console import Console
from uplift_cli.output.console import make_table
from uplift_cli.output.tables import SafeTable

WIDTHS = (60, 80)


def drawn(table, width):
    """Lines of a table in a window of a width."""
    out = io.StringIO()
    Console(file=out, width=width, highlight=False).print(table.fitted(width))
    return out.getvalue().splitlines()


def numbers(table):
    """Texts of all cells of numbers."""
    columns = [column for column in table.columns if column.justify == "right"]
    return [str(cell) for column in columns for cell in column.cells if str(cell)]


def check(table):
    counts = Counter(numbers(table))
    words = {word for column in table.columns for cell in column.cells for word in str(cell).split()}
    for width in WIDTHS:
        lines = drawn(table, width)
        assert max(map(cell_len, lines)) <= width
        text = "\n".join(lines)
        assert [number for number, count in counts.items() if text.count(number) < count] == []
        assert [word for word in words if word not in text and len(word) < 16] == []


@pytest.fixture
def tables(monkeypatch):
    """Tables that commands print."""
    printed = []
    fitted = SafeTable.fitted

    def record(table, width):
        printed.append(table)
        return fitted(table, width)

    monkeypatch.setattr(SafeTable, "fitted", record)
    return printed


COMMANDS = {
    "atlas": ("atlas",),
    "entries": ("atlas", "macbeth"),
    "info": ("info",),
    "wavelengths": (
        *("wavelengths", "--count", "4", "--method", "uniform", "--atlas", "macbeth"),
        *("--light", "D65", "--light", "A", "--light", "FL11", "--light", "LED-B3"),
    ),
    "compare": ("compare", "--quick", "--atlas", "macbeth", "--light", "A", "--light", "FL2"),
    "moments": ("study", "moments", "--max-moments", "2", "--atlas", "macbeth"),
    "palette": ("palette", "PALETTE"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_table_fits(run, tables, repository, name, monkeypatch):
    spec = repository / "uplift" / "samples" / "files" / "metamers.toml"
    args = [str(spec) if word == "PALETTE" else word for word in COMMANDS[name]]
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setenv("NO_COLOR", "1")
    result = run(*args)
    assert tables
    for table in list(tables):
        check(table)
    assert "\x1b" not in result.stdout
    assert max(map(cell_len, result.stdout.splitlines())) <= 60


def test_check_and_chart_fit(run, tables, monkeypatch):
    from uplift_cli.commands.chart import _print_fronts

    from uplift.lab.chart.table import shipped_chart

    monkeypatch.setenv("COLUMNS", "60")
    run("check", "missing.uplift", code=1)
    _print_fronts(shipped_chart())
    assert len(tables) > 2
    for table in list(tables):
        check(table)


def test_query_and_mix_fit(run, tables, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    (tmp_path / "colours.csv").write_text("0.2,0.4,0.6\n0.7,0.3,0.1\n")
    for args in (
        ("query", "0.2", "0.4", "0.6"),
        ("query", "--input", "colours.csv"),
        ("mix", "#005fa0", "#ffd200"),
    ):
        result = run(*args)
        assert max(map(cell_len, result.stdout.splitlines())) <= 60
    for table in list(tables):
        check(table)


def test_table_has_the_numbers_of_the_json(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    entries = json.loads(run("atlas", "macbeth", "--format", "json").stdout)["entries"]
    text = run("atlas", "macbeth").stdout
    for entry in entries:
        assert entry["name"] in text
        assert all(f"{value:.4f}" in text for value in entry["rgb"])
    args = ("wavelengths", "--count", "3", "--method", "uniform", "--atlas", "macbeth", "--light", "FL11")
    fields = json.loads(run(*args, "--format", "json").stdout)
    text = run(*args).stdout
    values = [value for row in fields["to_xyz"] + fields["to_rgb"] for value in row]
    assert all(f"{value:.4f}" in text for value in [*values, *fields["powers"]["FL11"]])


def test_wide_rows_fold_and_become_blocks():
    table = make_table(("name",), [f"number {column}" for column in range(12)])
    table.add_row("a row", *(f"{1234567.5 + column}" for column in range(12)))
    check(table)
    assert len(drawn(table, 200)) < len(drawn(table, 80)) < len(drawn(table, 60))
    prose = make_table(["first", *(f"heading {column}" for column in range(5))])
    prose.add_row(*(f"some words of text in column {column}" for column in range(6)))
    check(prose)


def test_the_check_detects_lost_numbers(monkeypatch):
    table = make_table(("name",), [f"number {column}" for column in range(12)])
    table.add_row("a row", *(f"{1234567.5 + column}" for column in range(12)))
    monkeypatch.setattr(SafeTable, "fitted", lambda self, width: self)
    with pytest.raises(AssertionError):
        check(table)


@pytest.mark.parametrize("width", ["1", "17", "40"])
def test_tiny_windows_have_lines_of_forty_characters(run, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", width)
    for args in (("query", "0.2", "0.4", "0.6"), ("info",), ("atlas",), ("mix", "#005fa0", "#ffd200")):
        assert max(map(cell_len, run(*args).stdout.splitlines())) <= 40
