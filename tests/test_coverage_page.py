"""docs/coverage.md: no empty row, and every command, option and module that it names exists."""

from __future__ import annotations

import re

import click
import pytest
from uplift_cli.main import main

from tests.conftest import ROOT

PAGE = (ROOT / "docs" / "coverage.md").read_text(encoding="utf-8")


def rows(text):
    """Cells of every row of the tables, without headings and rules."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [row for row in cells if row[0] != "section" and set(row[0]) != {"-"}]


def unknown_options(text):
    """Options next to a command in code that this command does not have, and unknown commands."""
    unknown = []
    with click.Context(main, **main.context_settings) as context:
        for code in re.findall(r"`uplift ([^`]+)`", text):
            name, *words = code.split()
            command = main.get_command(context, name)
            if isinstance(command, click.Group) and words:
                command = command.commands.get(words.pop(0))
            known = {option for each in (command.params if command else ()) for option in each.opts}
            unknown += [code] if command is None else []
            unknown += [word for word in words if word.startswith("-") and word not in known]
    return unknown


def test_no_row_is_empty():
    table = rows(PAGE)
    assert len(table) > 80
    assert [row for row in table if len(row) != 3 or not all(row)] == []


def test_every_row_names_a_place_or_a_reason():
    places = re.compile(r"`|\]\(|not |cannot|background")
    assert [row for row in rows(PAGE) if not places.search(row[2])] == []


def test_commands_and_options_exist():
    assert unknown_options(PAGE) == []


@pytest.mark.parametrize("title", ["Tódová", "Kment", "Meyer", "Bergner", "Fishkin"])
def test_every_document_has_a_table(title):
    assert re.search(rf"^## {title}.*\n\n\| section \|", PAGE, re.MULTILINE)
