"""List the codes of errors and warnings in the source: writes docs/data/errors.json."""

import ast
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
TARGET = ROOT / "docs" / "data" / "errors.json"
NAMED = {"unknown_name", "_look_up", "_samples"}
"""Functions whose third argument is the kind of a name; an unknown name has the code ``unknown-`` and the kind."""


def calls(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield the function name and the code of every call with a literal ``code`` or a literal kind of name."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        if name in NAMED and len(node.args) > 2 and isinstance(node.args[2], ast.Constant):
            yield name, "unknown-" + "-".join(str(node.args[2].value).casefold().split())
        for keyword in node.keywords:
            if keyword.arg == "code" and isinstance(keyword.value, ast.Constant):
                yield name, str(keyword.value.value)


def collect(root: Path = ROOT) -> list[dict[str, Any]]:
    """Return ``code``, ``kind`` ("error" or "warning") and ``packages`` that use it, by code."""
    found: dict[tuple[str, str], set[str]] = {}
    for path in sorted((root / "uplift").rglob("*.py")):
        package = ".".join(path.relative_to(root).parent.parts)
        for name, code in calls(ast.parse(path.read_text(encoding="utf-8"))):
            kind = "warning" if name.endswith(("Warning", "warn", "_warn")) else "error"
            found.setdefault((code, kind), set()).add(package)
    return [
        {"code": code, "kind": kind, "packages": sorted(packages)} for (code, kind), packages in sorted(found.items())
    ]


if __name__ == "__main__":
    TARGET.write_text(json.dumps({"codes": collect()}, indent=1) + "\n", encoding="utf-8")
