"""Parts of pages that are not rendered from templates yet."""

from __future__ import annotations

from collections.abc import Iterable

from uplift.viz.markup import Markup, element, rows


def swatch(*codes: str) -> Markup:
    """Adjoining colours, each as ``#rrggbb``."""
    parts = (element("i", style=f"background:{code}") for code in codes)
    return element("span", *parts, class_="swatch", title=" | ".join(codes))


def note(text: str) -> Markup:
    """Explanation of a table or figure."""
    return element("p", text, class_="note")


def table(headings: Iterable[str], lines: Iterable[Iterable[str | None]], class_: str = "slim") -> Markup:
    """Headings and rows in a box that scrolls on narrow screens."""
    head = element("thead", rows([headings], "th"))
    return element(
        "div", element("table", head, element("tbody", rows(lines)), class_=class_), class_="scroll"
    )


def right(heading: str, title: str | None = None, sort: str | None = None) -> Markup:
    """Heading over numbers."""
    return element("th", heading, class_="number", title=title, aria_sort=sort)
