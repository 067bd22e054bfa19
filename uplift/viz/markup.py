"""HTML that cannot be broken by what is written into it: all text is escaped unless it is `Markup`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape

EMPTY = ("br", "col", "meta")
"""Elements without content or end."""
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Markup(str):
    """Text that is HTML already."""


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


def format_scientific(value: float) -> str:
    """1.6 × 10⁻⁵, unbroken; from a hundredth on plainly, 0.0271."""
    if not math.isfinite(value):
        return "not finite"
    if value == 0 or 1e-2 <= abs(value) < 1e3:
        return f"{value:#.3g}".rstrip(".") if value else "0"
    digits, exponent = f"{value:.1e}".split("e")
    return f"{digits}\u00a0×\u00a0{_ten(int(exponent))}"


def format_power_of_ten(value: float) -> str:
    """A power of ten, as an axis has it."""
    return _ten(round(math.log10(value)))


def _ten(exponent: int) -> str:
    return f"10{str(exponent).translate(SUPERSCRIPT)}"


def format_rgb(rgb: Iterable[float]) -> str:
    """Linear RGB as it is written in a line."""
    return ", ".join(f"{value:.4f}" for value in rgb)


def pluralise(count: int, what: str, several: str | None = None) -> str:
    """``1 point``, ``2,000 points``."""
    return f"{count:,} {what if count == 1 else several or what + 's'}"
