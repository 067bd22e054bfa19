"""Errors and warnings carry explicit codes, and docs/errors.md lists them."""

from __future__ import annotations

import ast
import json

from tools.error_codes import calls, collect
from uplift.common import errors

from .conftest import ROOT

CLASSES = {name for name in errors.__all__ if isinstance(getattr(errors, name), type)}


def without_code(text):
    """Calls of error and warning classes that give no code."""
    return [
        ast.unparse(node)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in CLASSES
        and not {keyword.arg for keyword in node.keywords} & {"code", None}
    ]


def test_every_error_has_a_code():
    paths = [path for folder in ("uplift", "cli") for path in (ROOT / folder).rglob("*.py")]
    found = {path.name: without_code(path.read_text(encoding="utf-8")) for path in paths}
    assert {name: calls for name, calls in found.items() if calls} == {}


def test_a_missing_code_is_found():
    assert without_code("raise OptionError('dim must be at least 2')") != []
    assert without_code("raise OptionError('dim must be at least 2', code='dim-too-small')") == []


def test_codes_are_kebab_case():
    for row in collect():
        assert all((part.isalnum() and part.islower()) or part.isdigit() for part in row["code"].split("-")), row


def test_listed_codes_are_those_of_the_source():
    listed = json.loads((ROOT / "docs" / "data" / "errors.json").read_text(encoding="utf-8"))
    assert listed["codes"] == collect(), "run 'make docs'"


def test_calls_yields_literal_codes():
    tree = ast.parse("raise OptionError('x', code='too-small')\nwarn(UpliftWarning('y', code='left-out'))")
    assert sorted(calls(tree)) == [("OptionError", "too-small"), ("UpliftWarning", "left-out")]


def test_calls_yields_codes_of_unknown_names():
    assert list(calls(ast.parse("raise unknown_name(x, known, 'RGB space')"))) == [
        ("unknown_name", "unknown-rgb-space")
    ]
