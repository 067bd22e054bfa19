"""Render the pages of measurements: docs/templates/NAME.md.j2 filled from
docs/data/NAME.json is docs/NAME.md.

README.md.j2 is the README, above docs. Long tables of a page are CSV files that it
links to, in docs/tables.

Nothing is measured here. The programs in benchmarks/ write the data. A template without
data uses that of other pages, by ``load``. Numbers of the prose come from where they
are decided: ``code`` is a constant of the code, ``datum`` a measurement, and ``stated``
a number that a named source has.

Examples
--------
    python -m tools.render_docs                # all pages
    python -m tools.render_docs accuracy       # one page
"""

import json
import os
import re
import statistics
import string
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from itertools import chain
from operator import itemgetter
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Undefined

from uplift.extras.files.csv import csv_text
from uplift.extras.pages import format as viz_format
from uplift.lab.chart.recommendation import SITUATIONS, recommend_cube
from uplift.lab.chart.results import shipped_chart

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
TEMPLATES = DOCS / "templates"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
WRITTEN = re.compile(r"\d*\.?\d+(?:e-?\d+)?")
"""Numbers of a program."""
Row = Mapping[str, Any]


def number(value: Any, spec: str = "") -> str:
    """Format a value of the data by a format specification of Python, or "time",
    "size", "error", "build_time", "sci" (2e−7) or "power" (10⁻⁷).

    "time" takes nanoseconds, "size" bytes: the functions of
    `uplift.extras.pages.format`. None is an empty string, a bool a filled or an empty
    circle. The items of a list are joined by slashes, or by commas after "list ".
    ``{median, min, max}`` is written as "median (min–max)", ``{mean, std}`` as "mean ±
    std".
    """
    if value is None:
        return ""
    if isinstance(value, str | Undefined):
        return str(value)
    if isinstance(value, bool):
        return "●" if value else "○"
    if isinstance(value, list | tuple):
        separator = ", " if spec.startswith("list ") else " / "
        return separator.join(
            number(item, spec.removeprefix("list ")) for item in value
        )
    if isinstance(value, Mapping):
        parts = {key: number(item, spec) for key, item in value.items()}
        pattern = "{mean} ± {std}" if "std" in parts else "{median} ({min}–{max})"
        return pattern.format_map(parts)
    if spec in ("sci", "power"):
        return _scientific(value, spec)
    named = getattr(viz_format, f"format_{spec}", None)
    return named(value) if named else format(value, spec)


def _scientific(value: float, spec: str) -> str:
    digits, exponent = f"{value:e}".split("e")
    power = int(exponent)
    if spec == "power":
        return "10" + str(power).translate(SUPERSCRIPTS)
    return f"{float(digits):g}e{power}".replace("-", "−")


class RowFormatter(string.Formatter):
    """Fill a pattern such as ``{cube} | {worst:.1e}`` from a row; a dot leads into a
    nested dict or list.
    """

    def get_field(
        self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]
    ) -> Any:
        """Return the value at a dotted path."""
        value: Any = kwargs
        for key in field_name.split("."):
            value = value[int(key)] if isinstance(value, list) else value[key]
        return value, field_name

    def format_field(self, value: Any, format_spec: str) -> str:
        """Format as `number` does."""
        return number(value, format_spec)


def table(rows: Iterable[Row], caller: Callable[[], str]) -> str:
    """Return a Markdown table.

    The body of the ``call`` block has two lines: the headings, and the pattern of a
    row.
    """
    heading, pattern = filter(None, caller().splitlines())
    body = [RowFormatter().vformat(pattern, (), row) for row in rows]
    return markdown(heading, body)


def markdown(heading: str, body: Iterable[str]) -> str:
    """Return a Markdown table of lines whose cells are separated by bars."""
    rule = " | ".join(["---"] * (heading.count(" | ") + 1))
    return "".join(f"| {line} |\n" for line in (heading, rule, *body))


def wide(rows: Iterable[Row], down: str, across: str) -> list[Row]:
    """Return a row for each combination of the columns ``down`` (words), which has the
    rows of that combination by their values ``across``: ``{A.mean:.2f}`` is a cell.
    """
    found: dict[tuple[Any, ...], dict[str, Any]] = {}
    for row in rows:
        names = {column: row[column] for column in down.split()}
        found.setdefault(tuple(names.values()), names)[str(row[across])] = row
    return list(found.values())


def pivot(rows: Sequence[Row], down: str, across: str, cell: str) -> str:
    """Return `wide` rows as a Markdown table whose cells have a pattern, such as
    ``{mean:.2f} / {p95:.2f}``.
    """
    columns = list(dict.fromkeys(str(row[across]) for row in rows))
    body = []
    for row in wide(rows, down, across):
        cells = [number(row[name]) for name in down.split()]
        for name in columns:
            known = name in row
            cells.append(RowFormatter().vformat(cell, (), row[name]) if known else "")
        body.append(" | ".join(cells))
    return markdown(" | ".join([*down.split(), *columns]), body)


def average(rows: Iterable[Row], by: str) -> list[Row]:
    """Return the means of the floats of rows that agree in the columns ``by``
    (words).
    """
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in by.split()), []).append(row)
    found: list[Row] = []
    for names, same in groups.items():
        means = {
            column: statistics.fmean(map(itemgetter(column), same))
            for column, value in same[0].items()
            if isinstance(value, float)
        }
        found.append(means | dict(zip(by.split(), names, strict=True)))
    return found


def leaves(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the names and values of a nested row, the names joined by dots; floats have
    six digits, and the items of a list are one value.
    """
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from leaves(item, f"{name}.{key}" if name else str(key))
    elif isinstance(value, list):
        items = chain.from_iterable(map(leaves, value))
        yield name, "; ".join(str(leaf) for _, leaf in items)
    else:
        yield name, f"{value:.6g}" if isinstance(value, float) else value


def flat_csv(rows: Iterable[Row]) -> str:
    """Return nested rows as CSV, with a column for each leaf."""
    flat = [dict(leaves(row)) for row in rows]
    columns = list(dict.fromkeys(chain.from_iterable(flat)))
    return csv_text(columns, (list(map(row.get, columns)) for row in flat))


def where(rows: Iterable[Row], **conditions: Any) -> list[Row]:
    """Return the rows with these values."""
    return [row for row in rows if row.items() >= conditions.items()]


def pick(rows: Iterable[Row], **conditions: Any) -> Row:
    """Return the one row with these values; raise `ValueError` if there is none, or
    more than one.
    """
    (found,) = where(rows, **conditions)
    return found


def code(place: str) -> Any:
    """Return a constant of the code, such as ``package.module:NAME.0``."""
    module, _, path = place.partition(":")
    value: Any = import_module(module)
    for key in path.split("."):
        value = value[int(key)] if key.isdigit() else getattr(value, key)
    return value


def datum(name: str, path: str) -> Any:
    """Return a datum of docs/data/NAME.json at a path such as ``rows[key=value].0``."""
    value: Any = read_data(name)
    for key in re.findall(r"[^.\[\]]+(?:\[[^\]]*\])?", path):
        field, _, conditions = key.rstrip("]").partition("[")
        value = value[int(field)] if field.isdigit() else value[field]
        wanted = [pair.split("=") for pair in conditions.split(",") if pair]
        for column, cell in wanted:
            value = [row for row in value if str(row[column]) == cell]
        if wanted:
            (value,) = value
    return value


def stated(text: str, source: str) -> str:
    """Return a number as written in a source: a document, or a file of the project,
    which must have it.
    """
    path = ROOT / source
    if path.suffix == ".py":
        numbers = WRITTEN.findall(path.read_text(encoding="utf-8"))
        if float(text.replace("−", "-")) not in map(float, numbers):
            raise ValueError(f"{source} does not have the number {text}")
    return text


def recommended() -> list[Row]:
    """Return the cubes that ``uplift chart --recommend`` names, by situation."""
    chart = shipped_chart()
    return [
        {"title": name, "needed": each, "cube": recommend_cube(chart, each)}
        for name, each in SITUATIONS.items()
    ]


def pages() -> list[str]:
    """Return the names of the pages that have a template."""
    return sorted(
        path.relative_to(TEMPLATES).as_posix().removesuffix(".md.j2")
        for path in TEMPLATES.rglob("*.md.j2")
    )


def read_data(name: str) -> dict[str, Any]:
    """Return the data of a page: docs/data/NAME.json, empty if the page has none."""
    path = DOCS / "data" / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def read_text(path: str) -> str:
    """Return the text of a file of docs."""
    return (DOCS / path).read_text(encoding="utf-8")


def render(name: str, data: Mapping[str, Any] | None = None) -> dict[Path, str]:
    """Return the text of a page and of its CSV files, from its template and its data,
    by default the stored one.
    """
    page = (ROOT if name == "README" else DOCS) / f"{name}.md"
    tables = {}

    def long_table(rows: Iterable[Row], table_name: str) -> str:
        path = DOCS / "tables" / f"{table_name}.csv"
        tables[path] = flat_csv(rows)
        return f"[{path.name}]({Path(os.path.relpath(path, page.parent)).as_posix()})"

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters |= {"num": number, "mean": statistics.fmean}
    functions = {
        "code": code,
        "datum": datum,
        "load": read_data,
        "stated": stated,
        "text": read_text,
        "table": table,
        "where": where,
        "pick": pick,
        "wide": wide,
        "pivot": pivot,
        "average": average,
    }
    environment.globals |= functions | {
        "long_table": long_table,
        "recommended": recommended,
    }
    text = environment.get_template(f"{name}.md.j2").render(
        read_data(name) if data is None else data
    )
    return {page: text} | tables


if __name__ == "__main__":
    for name in sys.argv[1:] or pages():
        for path, text in render(name).items():
            path.write_text(text, encoding="utf-8")
