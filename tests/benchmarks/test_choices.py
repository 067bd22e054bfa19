"""Marks of optimistic figures: one list of choices for all pages."""

from __future__ import annotations

import json

import pytest

from benchmarks import choices
from benchmarks.cameras import ATLAS, CHOSEN_AS
from benchmarks.chart import optimistic_mark
from benchmarks.choices import ALONE, MARK, OURS, SHIPPED, is_optimistic, mark
from tests.conftest import ROOT
from tools.render_docs import read_data
from uplift.lab.chart.table import read_chart
from uplift.lab.study.held_out import SIGMOID


def test_a_choice_marks_its_methods_on_its_sets(monkeypatch):
    monkeypatch.setattr(choices, "CHOICES", (choices.Choice("length", ("macbeth",), (OURS,)),))
    assert is_optimistic(["vs", "macbeth"], OURS)
    assert not is_optimistic(["vs"], OURS)
    assert (mark(["macbeth"], OURS), mark(["macbeth"], ALONE)) == (MARK, "")


def test_the_sets_are_the_shipped_atlases():
    assert sorted(SHIPPED) == sorted(path.stem for path in (ROOT / "atlases").glob("*.txt"))


@pytest.mark.parametrize("page", ["held-out", "cameras", "chart"])
def test_stored_pages_agree_with_the_list(page):
    data = read_data(page)
    if page == "held-out":
        assert data["choices"] == json.loads(json.dumps([vars(choice) for choice in choices.CHOICES]))
        rows = [row | {"set": each["set"]} for each in data["sets"] for row in each["rows"]]
        assert all(row["optimistic"] == is_optimistic([row["set"]], row["method"]) for row in rows)
        assert {row["optimistic"] for row in rows} == {True, False}
    elif page == "cameras":
        assert set(data["marks"]) == set(data["rows"][0]["errors"])
        assert {name: text for name, text in data["marks"].items() if text} == {
            name: mark([ATLAS], method) for name, method in CHOSEN_AS.items()
        }
    else:
        rows = read_chart(ROOT / "uplift" / "lab" / "chart" / "measured.csv").measured
        assert {row["name"]: row["mark"] for row in data["methods"]} == {
            row.method: optimistic_mark(row) for row in rows
        }


def test_cubes_of_moments_are_marked_in_the_chart():
    marked = {row["name"] for row in read_data("chart")["methods"] if row["mark"]}
    every = {row["name"] for row in read_data("chart")["methods"]}
    assert marked == {name for name in every if name.removeprefix("c-").startswith("moments")}
    assert not is_optimistic(SHIPPED, SIGMOID)
