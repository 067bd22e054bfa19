"""``uplift info``: what a cube file holds."""

from __future__ import annotations

import json
from typing import Any

import click

from .options import format_option
from .output import console


@click.command("info")
@click.argument("file", required=False)
@format_option("table", "json")
def command(file: str | None, style: str) -> None:
    """Tell what a cube file holds and how it was made. Without FILE: the package's own cube.

    \b
    Examples:
      uplift info macbeth-32.uplift
      uplift info macbeth-32.uplift --format json | jq .status
    """
    from uplift.lookup import load
    from uplift.report.summary import summary

    facts = summary(load(file).data)
    if style == "json":
        click.echo(json.dumps(facts, indent=2, ensure_ascii=False))
    else:
        _table(file or "the package's own cube", facts)


def _table(name: str, facts: dict[str, Any]) -> None:
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(name), title_justify="left", show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold")
    table.add_column()
    for key, value in facts.items():
        table.add_row(key.replace("_", " "), Text(_text(value)))
    console().print(table)


def _text(value: Any) -> str:
    """Nested facts on lines of their own."""
    if isinstance(value, dict):
        return "\n".join(f"{key.replace('_', ' ')}: {_flat(inner)}" for key, inner in value.items())
    return _flat(value)


def _flat(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_flat(inner)}" for key, inner in value.items())
    if isinstance(value, list):
        return "; ".join(_flat(inner) for inner in value) or "none"
    return f"{value:.3g}" if isinstance(value, float) else str(value)
