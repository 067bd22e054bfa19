"""The pages of measurements are renderings of the stored data, and each has a program
in benchmarks/.
"""

import json

import jinja2
import pytest

from benchmarks import questions
from benchmarks.__main__ import pages
from tests.conftest import ROOT
from tests.parts import MITSUBA, need
from tools import render_docs
from tools.render_docs import read_data, render

DOCS = ROOT / "docs"


@pytest.mark.parametrize("name", pages())
def test_every_program_can_be_imported(name):
    if name in ("looks", "showcase"):
        need(MITSUBA)
    assert all(map(callable, questions(name).values()))


def test_every_stored_figure_names_a_page_that_can_be_measured():
    known = pages()
    for path in (DOCS / "data").glob("*.json"):
        command = json.loads(path.read_text("utf-8")).get("command", "")
        if command != "make nightly":
            assert not command or command.removeprefix("make measure PAGE=") in known, (
                path
            )


def test_committed_pages_and_tables_are_the_rendering_of_the_committed_data():
    files = {}
    for name in render_docs.pages():
        files |= render(name)
    for path, text in files.items():
        assert path.read_text("utf-8") == text, path
    assert set((DOCS / "tables").iterdir()) <= files.keys()


def test_a_missing_figure_is_an_error():
    data = read_data("accuracy")
    del data["ranges"]
    with pytest.raises(jinja2.UndefinedError, match="ranges"):
        render("accuracy", data=data)
