"""Tooltips of pages that extend ``viz/templates/interactive.html.j2``."""

from __future__ import annotations

from typing import TypedDict


class Tooltip(TypedDict):
    """Tooltip of the markers of one row.

    The parts of the picture that belong to row r have the identifiers ``marker-<panel>-<r>``, ``whisker-<panel>-<r>``
    and ``label-<panel>-<r>``. ``family`` is the checkbox that hides them; ``lines`` are names and values, a line
    without a name takes the full width.
    """

    title: str
    family: str
    lines: list[tuple[str, str]]
