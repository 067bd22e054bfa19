"""All text reaches the terminal through cli/output/console.py, which makes it safe."""

from __future__ import annotations

import ast

FORBIDDEN = {"echo", "secho", "print", "Console", "Table"}
"""Names that may be called in console.py, tables.py and progress.py only."""
DOORS = ("console.py", "tables.py", "progress.py")


def calls(tree):
    """Yield the names that a module calls."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            yield node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def test_no_other_module_prints(repository):
    for path in (repository / "cli").rglob("*.py"):
        if path.name not in DOORS:
            found = set(calls(ast.parse(path.read_text(encoding="utf-8")))) & FORBIDDEN
            assert not found, f"{path}: {found}"


def test_calls_are_found():
    assert {"echo", "Table"} <= set(calls(ast.parse("click.echo(1)\nx = Table()")))
