"""The pages of measurements are renderings of the stored data."""

from __future__ import annotations

import shutil
from typing import Any

import jinja2
import pytest

from tests.conftest import ROOT
from tools.render_docs import number, page_file, pages, pick, read_data, render, stale, table

DOCS = ROOT / "docs"


PAGES = pages()
TABLES = [
    (name, key)
    for name in PAGES
    for key, value in read_data(name).items()
    if isinstance(value, list) and value and isinstance(value[0], dict)
]


def changed(value: Any) -> Any:
    """Return a copy with every float changed."""
    if isinstance(value, dict):
        return {key: changed(item) for key, item in value.items()}
    if isinstance(value, list):
        return [changed(item) for item in value]
    return 3 * value + 1 if isinstance(value, float) else value


@pytest.mark.parametrize("name", PAGES)
def test_committed_page_is_the_rendering_of_the_committed_data(name):
    assert page_file(name).read_text(encoding="utf-8") == render(name)


@pytest.mark.parametrize(("name", "key"), TABLES)
def test_changed_figures_of_any_table_are_noticed(name, key):
    data = read_data(name)
    rows = [changed(row) for row in data[key]]
    if rows == data[key]:
        pytest.skip("the table has no fractions")
    try:
        text = render(name, data=data | {key: rows})
    except (LookupError, jinja2.UndefinedError):
        return  # The page picks rows by one of the changed values.
    assert text != page_file(name).read_text(encoding="utf-8")


def test_a_changed_number_in_the_page_is_noticed(tmp_path):
    for folder, file in (
        ("templates", "accuracy.md.j2"),
        ("templates", "macros.j2"),
        ("data", "accuracy.json"),
    ):
        (tmp_path / folder).mkdir(exist_ok=True)
        shutil.copy(DOCS / folder / file, tmp_path / folder)
    page = tmp_path / "accuracy.md"
    text = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    page.write_text(text, encoding="utf-8")
    assert stale(tmp_path) == []
    page.write_text(text.replace("e-04", "e-05", 1), encoding="utf-8")
    assert stale(tmp_path) == ["accuracy"]


def test_a_missing_figure_is_an_error():
    data = read_data("accuracy")
    del data["queries"]
    with pytest.raises(jinja2.UndefinedError, match="queries"):
        render("accuracy", data=data)


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
