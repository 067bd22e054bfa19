"""Printers of the list of shipped atlases."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from .console import make_table, paragraph, print_csv, print_json, say, show

if TYPE_CHECKING:
    from uplift.atlas import ShippedAtlas

COLUMNS = ("name", "entries", "content", "source", "licence")


def print_shipped(style: str) -> None:
    """Print the shipped atlases as table, JSON or CSV."""
    from uplift.atlas import shipped_atlases

    PRINTERS[style](shipped_atlases())


def _print_json(atlases: Iterable[ShippedAtlas]) -> None:
    rows = [_record(atlas) | {"path": str(atlas.path), "digest": atlas.digest} for atlas in atlases]
    print_json({"atlases": rows})


def _print_csv(atlases: Iterable[ShippedAtlas]) -> None:
    print_csv(COLUMNS, (list(_record(atlas).values()) for atlas in atlases))


def _print_table(atlases: Iterable[ShippedAtlas]) -> None:
    table = make_table()
    for title in COLUMNS:
        number = title == "entries"
        wrapped = title not in ("name", "entries")
        table.add_column(title, justify="right" if number else "left", no_wrap=not wrapped, overflow="fold")
    for atlas in atlases:
        table.add_row(*(str(value) for value in _record(atlas).values()))
    show(table)
    say()
    paragraph("Use a name as --atlas NAME, or in place of FILE.")


def _record(atlas: ShippedAtlas) -> dict[str, Any]:
    return {name: getattr(atlas, name) for name in COLUMNS}


PRINTERS: dict[str, Callable[[Iterable[ShippedAtlas]], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
