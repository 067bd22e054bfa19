"""Fuzz target: exceptions that uplift does not expect, raised inside a command with the last net on."""

from __future__ import annotations

import json
import os
from pathlib import Path
from unittest import mock

from click.testing import CliRunner
from uplift_cli.main import main

from tests.fuzz.command_line import choose
from tests.fuzz.hostile_text import hostile
from tests.fuzz.mutate import Random
from tests.fuzz.target import Target
from uplift.common.errors import UpliftError
from uplift.common.text import printable

EXCEPTIONS = (
    ValueError, TypeError, KeyError, IndexError, AttributeError, RuntimeError, ZeroDivisionError, AssertionError,
    RecursionError, NotImplementedError, ImportError, LookupError, ArithmeticError, StopIteration, UnicodeError,
    BufferError, EOFError, MemoryError, OSError, PermissionError, FileNotFoundError, TimeoutError, ConnectionError,
    ExceptionGroup, KeyboardInterrupt,
)  # fmt: skip
CODES = {"MemoryError": 2, "KeyboardInterrupt": 130, "EOFError": 70}
"""Exit codes of exceptions; those of the system have 2, and all others 70."""


def _generate(random: Random, path: Path) -> None:
    kind = int(random.integers(-8, len(EXCEPTIONS)))
    style = choose(random, ("table", "json"))
    path.write_text(json.dumps({"kind": kind, "text": hostile(random), "style": style}), encoding="ascii")


def _use(path: Path) -> None:
    case = json.loads(path.read_text(encoding="ascii"))
    if case["kind"] < 0:
        return
    kind = EXCEPTIONS[case["kind"]]
    error = kind(case["text"], [ValueError("inner")]) if kind is ExceptionGroup else kind(case["text"])
    environment = {name: value for name, value in os.environ.items() if name != "UPLIFT_TRACEBACK"}
    with (
        mock.patch("uplift.lookup.load", side_effect=error),
        mock.patch.dict(os.environ, environment, clear=True),
    ):
        result = CliRunner().invoke(main, ["info", "x", "--format", case["style"]], catch_exceptions=False)
    expected = CODES.get(kind.__name__, 2 if issubclass(kind, OSError) else 70)
    lines = [line for line in result.stderr.split("\n") if line]
    if result.exit_code != expected or len(lines) > 1 or result.stdout:
        raise ValueError(f"{kind.__name__}: exit code {result.exit_code}, {len(lines)} lines")
    if any(printable(line) != line for line in lines):
        raise ValueError("a control character")
    raise UpliftError("reported on one line")


TARGET = Target("unforeseen exceptions", _generate, _use)
