"""Tables in narrow windows: texts are wrapped, and no number is lost."""

from __future__ import annotations

import json

import pytest
from rich.cells import cell_len
from uplift_cli.output.console import make_table, show


def test_texts_are_wrapped_and_numbers_are_whole(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    table = make_table(("name",), ("first", "second"))
    table.add_column("text")
    table.add_row("a row", "1234567.5", "7654321.5", "some words of text, and averyveryverylongword")
    show(table)
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) > 4
    assert {cell_len(line) for line in lines} == {5 + 9 + 9 + 16 + 3 * 2}
    assert "a row  1234567.5  7654321.5  some words of" in lines[2]
    assert "".join(line[27:].strip() for line in lines[2:]).endswith("averyveryverylongword")


def test_texts_are_shown_as_they_are(capsys):
    table = make_table(("name",))
    table.add_row("[red]a\x1b[2J")
    show(table)
    assert "[red]a\\x1b[2J" in capsys.readouterr().out


@pytest.mark.parametrize("width", ["1", "60", "200"])
def test_tables_have_the_numbers_of_the_json(run, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", width)
    entries = json.loads(run("atlas", "macbeth", "--format", "json").stdout)["entries"]
    text = run("atlas", "macbeth").stdout
    for entry in entries:
        assert entry["name"] in text
        assert all(f"{value:.4f}" in text for value in entry["rgb"])


@pytest.mark.parametrize("words", ["query 0.2 0.4 0.6", "mix #005fa0 #ffd200"])
def test_tiny_windows_have_lines_of_forty_characters(run, monkeypatch, words):
    monkeypatch.setenv("COLUMNS", "1")
    assert max(map(cell_len, run(*words.split()).stdout.splitlines())) <= 40
