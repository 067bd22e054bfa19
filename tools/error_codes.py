"""List the codes of errors and warnings in the source: writes docs/data/errors.json."""

import ast
import json
from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
TARGET = ROOT / "docs" / "data" / "errors.json"
KEYWORDS = {"code", "foreign"}
"""Arguments that are codes."""


def codes(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield function or class and code: of classes, of arguments, and of names that
    have a text in the same file.
    """
    named = assigned_values(ast.walk(tree))
    for node in ast.walk(tree):
        name = ""
        values: list[ast.expr] = []
        if isinstance(node, ast.ClassDef):
            name = node.name
            members = [item for item in node.body if isinstance(item, ast.Assign)]
            values = assigned_values(members)["code"]
        elif isinstance(node, ast.Call):
            name = ast.unparse(node.func).rpartition(".")[2]
            for keyword in node.keywords:
                if keyword.arg in KEYWORDS:
                    value = keyword.value
                    values += named.get(ast.unparse(value), [value])
        for value in values:
            if isinstance(value, ast.Constant) and value.value:
                yield name, str(value.value)


def assigned_values(nodes: Iterable[ast.AST]) -> dict[str, list[ast.expr]]:
    """Return the values that are assigned to each name."""
    values = defaultdict(list)
    for node in nodes:
        if isinstance(node, ast.Assign):
            targets = getattr(node.targets[0], "elts", node.targets)
            parts = getattr(node.value, "elts", [node.value])
            for target, value in zip(targets, parts, strict=False):
                values[ast.unparse(target)].append(value)
    return values


def collect(root: Path = ROOT) -> list[dict[str, Any]]:
    """Return records of ``code``, ``kind`` and ``packages`` that use it, by code."""
    users: dict[tuple[str, str], set[str]] = defaultdict(set)
    sources = chain((root / "cli").rglob("*.py"), (root / "uplift").rglob("*.py"))
    for path in sources:
        package = ".".join(path.relative_to(root).parent.parts)
        for name, code in codes(ast.parse(path.read_text(encoding="utf-8"))):
            kind = "warning" if "warn" in name.lower() else "error"
            users[code, kind].add(package)
    return [
        {"code": code, "kind": kind, "packages": sorted(packages)}
        for (code, kind), packages in sorted(users.items())
    ]


if __name__ == "__main__":
    TARGET.write_text(
        json.dumps({"codes": collect()}, indent=1) + "\n", encoding="utf-8"
    )
