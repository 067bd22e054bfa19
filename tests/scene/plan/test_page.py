"""The page, and what to type."""

from __future__ import annotations

import shlex
from html.parser import HTMLParser

import click
from uplift_cli.main import main

from uplift.scene.plan.commands import build_command, cube_name, expanded_command, texture_command
from uplift.scene.plan.final_build import FinalBuild
from uplift.scene.plan.page import page
from uplift.scene.plan.summary import summary_rows, verdict

EMPTY = {"meta", "br", "col"}


class Reader(HTMLParser):
    """Text and open elements; an end that fits none is an error."""

    def __init__(self):
        super().__init__()
        self.open, self.texts = [], []

    def handle_starttag(self, tag, attrs):
        if tag not in EMPTY:
            self.open.append(tag)
        assert not {"src", "href"} & {name for name, value in attrs if not (value or "").startswith("#")}

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


def test_the_page_is_whole_needs_nothing_else_and_shows_every_candidate(planned, tmp_path):
    found, _ = planned
    text = page(found, tmp_path / "kitchen.plan.json")
    reader = Reader()
    reader.feed(text)
    assert reader.open == []
    told = "\n".join(reader.texts)
    for decision in found.decisions:
        assert decision.title in told
        assert all(trial.name in told for trial in decision.trials)
    assert f"{verdict(found)}." in told
    charts = sum(len(decision.trials) > 1 for decision in found.decisions)
    assert text.count("<svg") == charts + 1
    assert text == page(found, tmp_path / "kitchen.plan.json")


def test_every_row_says_what_it_costs(planned):
    found, _ = planned
    told = summary_rows(found)
    assert [row.title for row in told][:3] == ["Coefficients a spectrum", "Lattice", "Cells"]
    assert all(row.chosen and row.cost and row.error for row in told)


def test_a_cube_that_is_not_sparse_says_why(planned):
    built = planned[0].final_build
    assert not built.is_sparse
    assert "too little saved" in next(row for row in summary_rows(planned[0]) if row.title == "Cells").cost
    assert isinstance(built, FinalBuild)
    assert built.sparse <= built.whole


def test_the_lines_are_lines_of_the_command_line(planned, tmp_path):
    found, _ = planned
    path = tmp_path / "my plan.plan.json"
    assert cube_name(path) == "my plan.uplift"
    for line in (build_command(path), expanded_command(found, path), texture_command(found, path)):
        program, name, *arguments = shlex.split(line)
        assert program == "uplift"
        with click.Context(main, **main.context_settings) as context:
            main.get_command(context, name).make_context(name, arguments, parent=context)
    words = shlex.split(expanded_command(found, path))
    assert words[words.index("--dim") + 1] == str(found.options["dim"])
    assert words[words.index("--moments") + 1] == str(found.options["coefficients"] - 1)
