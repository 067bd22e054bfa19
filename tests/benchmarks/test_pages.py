"""The pages of measurements are renderings of the stored data, and each has a program
in benchmarks/.
"""

import json

import jinja2
import pytest

from benchmarks import choices, questions
from benchmarks.__main__ import pages
from benchmarks.chart import RIVALS, optimistic_mark
from benchmarks.choices import MARK, mark
from benchmarks.materials import MIXTURE, SHIPPED
from tests.conftest import ROOT
from tests.parts import MITSUBA, need
from tools import render_docs
from tools.render_docs import read_data, render
from uplift.lab.chart.results import read_chart
from uplift.lab.study.held_out import HALF, NO_ATLAS

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
    del data["queries"]
    with pytest.raises(jinja2.UndefinedError, match="queries"):
        render("accuracy", data=data)


def test_a_choice_marks_its_methods_on_its_sets(monkeypatch):
    stems = {path.stem for path in (ROOT / "atlases").glob("*.txt")}
    assert set(SHIPPED) == stems
    choice = {"choice": "length", "sets": ["macbeth"], "methods": [HALF]}
    monkeypatch.setattr(choices, "CHOICES", [choice])
    assert mark("macbeth", HALF) == mark(MIXTURE, HALF) == MARK
    assert mark("vs", HALF) == mark("macbeth", NO_ATLAS) == ""


def test_marks_of_the_chart_are_those_of_its_rows():
    rows = read_chart(ROOT / "uplift" / "lab" / "chart" / "measured.csv").measured
    methods = read_data("chart")["chart"]["methods"]
    stored = {row["name"]: row["mark"] for row in methods}
    assert stored == {row.method: optimistic_mark(row) for row in rows}
    for name, text in stored.items():
        of_moments = name.removeprefix("c-").startswith("moments")
        assert bool(text) == (of_moments or name in RIVALS)
