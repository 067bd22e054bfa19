"""The page around a picture with markers to hover over: what pages of several pictures share."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from typing import TypedDict

from uplift.viz.markup import Markup, element, joined


class Told(TypedDict):
    """What hovering over the markers of a row tells; a line is a name and a value."""

    title: str
    family: str
    lines: list[tuple[str, str]]


def document(title: str, lead: str, parts: Iterable[Markup | None], rows: Sequence[Told]) -> str:
    """A whole HTML text that needs nothing else. Row r is told of the parts of a picture that are named
    ``marker-<panel>-<r>``, ``whisker-…`` or ``label-…``."""
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("style", Markup(_both("page.css"))),
    )
    body = element(
        "body",
        element("header", element("h1", title), element("p", lead, class_="lead")),
        *parts,
        element("div", id="tip", hidden=""),
        element("script", _data(rows), type="application/json", id="rows"),
        element("script", Markup(_both("page.js"))),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def family_boxes(families: Mapping[str, str]) -> Markup:
    """A box for each family, to show and hide it; their colours are ``#rrggbb``."""
    boxes = [
        element(
            "label",
            element("input", type="checkbox", checked="", value=name),
            element("i", style=f"background:{colour}"),
            name,
        )
        for name, colour in families.items()
    ]
    return element("p", *boxes, class_="families")


def footer(facts: Mapping[str, str], sources: Iterable[str]) -> Markup:
    """Where and how it was measured, and what it is from."""
    told = [element("div", element("dt", name), element("dd", text)) for name, text in facts.items()]
    return element("footer", element("dl", *told), joined(element("p", source) for source in sources))


def _both(name: str) -> str:
    """What every page has, and what these have beside it."""
    return "".join(
        files(package).joinpath(name).read_text(encoding="utf-8")
        for package in ("uplift.viz", "uplift.lab.chart")
    )


def _data(rows: Sequence[Told]) -> Markup:
    return Markup(json.dumps(rows, ensure_ascii=False).replace("<", "\\u003c"))
