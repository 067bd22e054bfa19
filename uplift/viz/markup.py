"""HTML that cannot be broken by what is written into it: all text is escaped unless it is `Markup`."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from markupsafe import Markup as Markup

from uplift.viz.format import pluralise as pluralise

EMPTY = ("br", "col", "meta")
"""Elements without content or end."""


def element(tag: str, *children: str | None, **attributes: str | int | None) -> Markup:
    """An element. Children that are not `Markup` are text and are escaped, as all attributes are; what is
    None is left out. ``class_`` is ``class``, and underscores within names are hyphens."""
    stated = "".join(
        f' {name.rstrip("_").replace("_", "-")}="{escape(str(value))}"'
        for name, value in attributes.items()
        if value is not None
    )
    if tag in EMPTY:
        return Markup(f"<{tag}{stated}>")
    return Markup(f"<{tag}{stated}>{joined(children)}</{tag}>")


def joined(parts: Iterable[str | None]) -> Markup:
    """Parts one after the other, escaped where they are text; None is left out."""
    return Markup(
        "".join(part if isinstance(part, Markup) else escape(part) for part in parts if part is not None)
    )


def rows(cells: Iterable[Iterable[str | None]], tag: str = "td") -> Markup:
    """Table rows; a cell that is no ``td`` or ``th`` already becomes one, None is left out."""
    return joined(element("tr", *(_cell(cell, tag) for cell in row if cell is not None)) for row in cells)


def _cell(cell: str, tag: str) -> Markup:
    made = isinstance(cell, Markup) and cell.startswith(("<td", "<th"))
    return Markup(cell) if made else element(tag, cell)


def number(value: str, **attributes: str | int | None) -> Markup:
    """A table cell that is aligned right, digits under digits."""
    return element("td", value, **{"class_": "number", **attributes})
