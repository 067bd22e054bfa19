"""The command line as a fuzz target: what a run may print, and the exit codes that it may have.

A case is JSON with the arguments and the files of a run. Tracebacks, control characters and second lines of errors are
failures; an exit code of 2 is a rejected input.
"""

from __future__ import annotations

import csv
import io
import json
import os
import re
import tempfile
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from click.testing import CliRunner
from uplift_cli.main import main

from tests.fuzz.mutate import Random
from uplift.common.errors import UpliftError
from uplift.common.text import printable

Make = Callable[[str, Path], None]
"""Writes a file from its text in a case."""


@dataclass(frozen=True)
class Outcome:
    """What a run printed, and its exit code."""

    code: int
    stdout: str
    stderr: str


def choose(random: Random, items: Sequence[Any]) -> Any:
    """Return one of the items."""
    return items[random.integers(len(items))]


def write_case(path: Path, args: Sequence[str], files: Mapping[str, str]) -> None:
    """Write a case."""
    path.write_text(json.dumps({"args": list(args), "files": dict(files)}), encoding="ascii")


def run_case(path: Path, make: Make) -> Outcome:
    """Run a case in a temporary folder that has its files."""
    case = json.loads(path.read_text(encoding="ascii"))
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        before = os.getcwd()
        os.chdir(folder)
        try:
            for name, text in case["files"].items():
                make(text, Path(name))
            return run(case["args"])
        finally:
            os.chdir(before)


def run(args: Sequence[str]) -> Outcome:
    """Run ``uplift`` in this process. Raises the exception of an internal error."""
    previous = os.environ.get("UPLIFT_TRACEBACK")
    os.environ["UPLIFT_TRACEBACK"] = "1"
    try:
        with warnings.catch_warnings(action="ignore"):
            result = CliRunner().invoke(main, list(args), catch_exceptions=False)
    finally:
        if previous is None:
            del os.environ["UPLIFT_TRACEBACK"]
    return Outcome(result.exit_code, result.stdout, result.stderr)


def check_outcome(outcome: Outcome) -> None:
    """Check a run. Raises `UpliftError` for rejected input, ValueError for what it must not print."""
    for line in (*outcome.stdout.split("\n"), *outcome.stderr.split("\n")):
        if printable(line) != line:
            raise ValueError("a control character")
    errors = [line for line in outcome.stderr.splitlines() if not line.startswith("warning: ")]
    if outcome.code == 2:
        if len(errors) != 1 or not is_error(errors[0]):
            raise ValueError(f"{len(errors)} lines of an error")
        raise UpliftError("rejected")
    if outcome.code not in (0, 1):
        raise ValueError(f"exit code {outcome.code}")
    if len(errors) > 1:
        raise ValueError(f"{len(errors)} lines on standard error")


def is_error(line: str) -> bool:
    """Whether a line reports an error, as text or as JSON."""
    return line.startswith("error: ") or "error" in json.loads(line)


def check_csv(text: str) -> None:
    """Check that no cell is a formula. Raises ValueError."""
    for row in csv.reader(io.StringIO(text, newline="")):
        for cell in row:
            if cell[:1] in tuple("=+-@\t\r") and cell and not re.fullmatch(r"[+-]?[\d.]+(e[+-]?\d+)?", cell):
                raise ValueError("a cell that is a formula")
