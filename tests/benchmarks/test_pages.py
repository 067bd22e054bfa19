"""The pages of measurements are renderings of the stored data, and each has a program
in benchmarks/.
"""

import importlib
import json

import jinja2
import pytest

from benchmarks import choices
from benchmarks.__main__ import pages
from benchmarks.cameras import ATLAS, CHOSEN_AS
from benchmarks.chart import RIVALS, optimistic_mark
from benchmarks.choices import ALONE, MARK, OURS, is_optimistic, mark
from benchmarks.materials import SHIPPED
from tests.conftest import ROOT
from tests.parts import MITSUBA, need
from tools import render_docs
from tools.render_docs import read_data, render
from uplift.lab.chart.results import read_chart

DOCS = ROOT / "docs"


@pytest.mark.parametrize("name", pages())
def test_every_program_can_be_imported(name):
    if name in ("render", "looks", "showcase"):
        need(MITSUBA)
    assert callable(
        importlib.import_module(f"benchmarks.{name.replace('-', '_')}").main
    )


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
    assert sorted(SHIPPED) == sorted(
        path.stem for path in (ROOT / "atlases").glob("*.txt")
    )
    monkeypatch.setattr(
        choices, "CHOICES", (choices.Choice("length", ("macbeth",), (OURS,)),)
    )
    assert is_optimistic(["vs", "macbeth"], OURS)
    assert not is_optimistic(["vs"], OURS)
    assert (mark(["macbeth"], OURS), mark(["macbeth"], ALONE)) == (MARK, "")


def test_stored_marks_agree_with_the_choices():
    held_out = read_data("held-out")
    current = json.dumps([vars(choice) for choice in choices.CHOICES])
    assert held_out["choices"] == json.loads(current)
    for results in held_out["sets"]:
        for row in results["rows"]:
            assert row["optimistic"] == is_optimistic([results["set"]], row["method"])
    marks = {name: text for name, text in read_data("cameras")["marks"].items() if text}
    assert marks == {name: mark([ATLAS], method) for name, method in CHOSEN_AS.items()}


def test_marks_of_the_chart_are_those_of_its_rows():
    rows = read_chart(ROOT / "uplift" / "lab" / "chart" / "measured.csv").measured
    stored = {row["name"]: row["mark"] for row in read_data("chart")["methods"]}
    assert stored == {row.method: optimistic_mark(row) for row in rows}
    for name, text in stored.items():
        of_moments = name.removeprefix("c-").startswith("moments")
        assert bool(text) == (of_moments or name in RIVALS)
