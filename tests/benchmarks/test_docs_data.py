"""The pages of measurements are renderings of the stored data."""

from __future__ import annotations

import json
import shutil
from typing import Any

import jinja2
import pytest

from tests.conftest import ROOT
from tools.render_docs import number, pages, pick, render, stale, table

DOCS = ROOT / "docs"


def numbers(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of the floats in a JSON document."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    found = [where for key, item in items for where in numbers(item, (*path, key))]
    return found + ([path] if isinstance(value, float) else [])


@pytest.mark.parametrize("name", pages())
def test_committed_page_is_the_rendering_of_the_committed_data(name):
    assert (DOCS / f"{name}.md").read_text(encoding="utf-8") == render(name)


@pytest.fixture
def docs(tmp_path):
    """A copy of one page with its template and data, and of nothing else."""
    copy = tmp_path / "docs"
    for folder, files in {
        "templates": ("accuracy.md.j2", "macros.j2"),
        "data": ("accuracy.json",),
        ".": ("accuracy.md",),
    }.items():
        (copy / folder).mkdir(parents=True, exist_ok=True)
        for file in files:
            shutil.copy(DOCS / folder / file, copy / folder)
    return copy


def test_a_changed_number_in_the_page_is_noticed(docs):
    assert stale(docs) == []
    page = docs / "accuracy.md"
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace("e-04", "e-05", 1), encoding="utf-8")
    assert stale(docs) == ["accuracy"]


def test_every_changed_number_in_the_data_is_noticed(docs):
    path = docs / "data" / "accuracy.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    places = numbers(data)
    assert len(places) > 20
    for *parents, last in places:
        changed = json.loads(json.dumps(data))
        target = changed
        for key in parents:
            target = target[key]
        target[last] = target[last] * 3 + 1
        path.write_text(json.dumps(changed), encoding="utf-8")
        assert stale(docs) == ["accuracy"], [*parents, last]


def test_a_missing_figure_is_an_error(docs):
    path = docs / "data" / "accuracy.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    del data["queries"]
    path.write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(jinja2.UndefinedError, match="queries"):
        stale(docs)


@pytest.mark.parametrize(
    ("value", "spec", "text"),
    [
        (None, ".2f", ""),
        ("none", ".2f", "none"),
        (True, "", "●"),
        (1234.5, ",.0f", "1,234"),
        (4200, "time", "4.2 µs"),
        (0.00001, "error", "< 0.0001"),
        ([1, 2.5], ".1f", "1.0 / 2.5"),
        ([1, 2.5], "list .1f", "1.0, 2.5"),
        ({"median": 2, "min": 1, "max": 3, "runs": 5}, ".1f", "2.0 (1.0–3.0)"),
        ({"mean": 2, "std": 0.5}, ".1f", "2.0 ± 0.5"),
    ],
)
def test_formats_of_numbers(value, spec, text):
    assert number(value, spec) == text


def test_table_fills_a_row_pattern():
    rows = [{"name": "x", "errors": {"FL2": [1.0, 2.0]}}]
    text = table(rows, lambda: "\nname | mean\n{name} | {errors.FL2.0:.1f}\n")
    assert text == "| name | mean |\n| --- | --- |\n| x | 1.0 |\n"


def test_pick_returns_the_only_match():
    rows = [{"a": 1, "b": 2}, {"a": 1, "b": 3}]
    assert pick(rows, b=3) == rows[1]
    with pytest.raises(LookupError, match="2 rows"):
        pick(rows, a=1)
