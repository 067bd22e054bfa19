"""List the codes of errors and warnings in the source: writes docs/data/errors.json."""

import ast
import json
from collections import defaultdict
from collections.abc import Iterator
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
    named = _assigned(tree)
    for node in ast.walk(tree):
        values: list[ast.expr] = []
        if isinstance(node, ast.ClassDef):
            name = node.name
            values = _assigned(ast.Module(node.body, []))["code"]
        elif isinstance(node, ast.Call):
            name = ast.unparse(node.func).rpartition(".")[2]
            for keyword in node.keywords:
                if keyword.arg in KEYWORDS:
                    text = ast.unparse(keyword.value)
                    values += named.get(text, [keyword.value])
        for value in values:
            if isinstance(value, ast.Constant) and value.value:
                yield name, str(value.value)


def _assigned(tree: ast.AST) -> dict[str, list[ast.expr]]:
    """Return the values that are assigned to each name of a file or class."""
    named = defaultdict[str, list[ast.expr]](list)
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            targets = getattr(node.targets[0], "elts", [node.targets[0]])
            values = getattr(node.value, "elts", [node.value])
            for target, value in zip(targets, values, strict=False):
                named[ast.unparse(target)].append(value)
    return named


def collect(root: Path = ROOT) -> list[dict[str, Any]]:
    """Return ``code``, ``kind`` ("error" or "warning") and ``packages`` that use it, by
    code.
    """
    found: dict[tuple[str, str], set[str]] = {}
    for path in sorted(
        chain.from_iterable(
            (root / folder).rglob("*.py") for folder in ("cli", "uplift")
        )
    ):
        package = ".".join(path.relative_to(root).parent.parts)
        for name, code in codes(ast.parse(path.read_text(encoding="utf-8"))):
            kind = "warning" if "warn" in name.lower() else "error"
            found.setdefault((code, kind), set()).add(package)
    return [
        {"code": code, "kind": kind, "packages": sorted(packages)}
        for (code, kind), packages in sorted(found.items())
    ]


if __name__ == "__main__":
    TARGET.write_text(
        json.dumps({"codes": collect()}, indent=1) + "\n", encoding="utf-8"
    )
