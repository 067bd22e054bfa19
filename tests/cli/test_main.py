"""Behaviour that all commands share: help, exit codes, errors and warnings on one line."""

from __future__ import annotations

import ast
import errno
import importlib
import json
import subprocess
import sys
import warnings

import click
import pytest
from click.testing import CliRunner
from uplift_cli.main import COMMANDS, main
from uplift_cli.output.hints import HINTS

import uplift
from uplift.common.errors import UpliftError, UpliftWarning
from uplift.common.text import printable

from .conftest import warning_lines


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_a_sentence_and_examples(run, name):
    usage, sentence, *rest = run(name, "--help").stdout.split("\n\n")
    assert usage.startswith(f"Usage: main {name} ")
    assert sentence.strip().endswith(".")
    (examples,) = [part for part in rest if part.startswith("  Examples:\n")]
    lines = examples.replace("\\\n", "").splitlines()[1:]
    assert all(f"uplift {name} " in f"{line} " for line in lines)


def test_help_lists_every_command_under_a_heading(run):
    lines = run("--help").stdout.splitlines()
    for name in COMMANDS:
        assert sum(line.startswith(f"  {name} ") for line in lines) == 1


def test_version(run):
    assert run("--version").stdout == f"uplift {uplift.__version__}\n"


@pytest.mark.parametrize(
    "args",
    [
        ("paint",),
        ("query", "--nosuch"),
        ("query",),
        ("build", "--dim", "many"),
        ("query", "--format", "xml", "#fff"),
        ("info", "a", "b"),
    ],
)
def test_wrong_usage_is_a_click_error_with_exit_code_2(misuse, args):
    misuse(*args)


@pytest.fixture
def failing(monkeypatch):
    """Make ``uplift info x`` raise an error."""

    def failing(error):
        def fail(path):
            raise error

        monkeypatch.setattr("uplift.lookup.load", fail)

    return failing


def test_errors_are_one_line_with_exit_code_2(failing, run):
    failing(UpliftError("is bad", code="no-such-code", path="x", line=3, hint="make it good"))
    result = run("info", "x", code=2)
    assert (result.stdout, result.stderr) == ("", "error: x:3: is bad; make it good\n")


def test_hints_of_the_command_line_replace_those_of_the_library(failing, run):
    failing(UpliftError("exists already", code="file-exists", path="x", hint="pass force=True"))
    hint = HINTS["file-exists"]
    assert run("info", "x", code=2).stderr == f"error: x: exists already; {hint}\n"
    result = run("info", "x", "--format", "json", code=2)
    assert (result.stdout, result.stderr.count("\n")) == ("", 1)
    fields = {"code": "file-exists", "where": "x", "problem": "exists already", "hint": hint}
    assert json.loads(result.stderr) == {"error": fields}


@pytest.fixture
def net(monkeypatch):
    """Let the command line report internal errors, as users have it."""
    monkeypatch.delenv("UPLIFT_TRACEBACK")


@pytest.mark.usefixtures("net")
@pytest.mark.parametrize(
    "bug",
    [RuntimeError("a bug\nof two lines\x1b[2J"), ZeroDivisionError(), UnicodeEncodeError("utf-8", "\udcff", 0, 1, "x")],
)
def test_internal_errors_are_one_line_with_exit_code_70(failing, run, bug):
    failing(bug)
    result = run("info", "x", code=70)
    assert result.stdout == ""
    assert result.stderr.startswith(f"error: internal error, please report it: {type(bug).__name__} in test_main.py:")
    assert result.stderr.count("\n") == 1
    assert printable(result.stderr[:-1]) == result.stderr[:-1]


@pytest.mark.usefixtures("net")
def test_internal_errors_are_json_for_json_output(failing, run):
    failing(KeyError("name"))
    result = run("info", "x", "--format", "json", code=70)
    assert json.loads(result.stderr)["error"]["code"] == "internal-error"


@pytest.mark.usefixtures("net")
def test_traceback_shows_more(failing, home):
    failing(KeyError("name"))
    result = CliRunner().invoke(main, ["--traceback", "info", "x"])
    assert isinstance(result.exception, KeyError)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (MemoryError(), "out-of-memory"),
        (RuntimeError("RESOURCE_EXHAUSTED: Out of memory allocating 9 bytes."), "out-of-memory"),
        (PermissionError(13, "Permission denied", "x"), "output"),
        (OSError(errno.ENOSPC, "No space left on device"), "output"),
    ],
)
def test_failures_of_the_system_are_errors(failing, refuse, error, code):
    failing(error)
    assert refuse("info", "x").code == code


def test_warnings_of_the_library_are_one_line_each_and_others_are_ignored(monkeypatch, run):
    def load(path):
        warnings.warn(UpliftWarning("is left out", code="file-exists", entry="a"), stacklevel=2)
        warnings.warn(UpliftWarning("is left out", code="no-such-code", entry="a"), stacklevel=2)
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.warn("internal", RuntimeWarning, stacklevel=2)
        return cube

    cube = uplift.load()
    monkeypatch.setattr("uplift.lookup.load", load)
    before = warnings.showwarning
    result = run("info")
    assert warning_lines(result) == [
        f"entry 'a': is left out; {HINTS['file-exists']}",
        "entry 'a': is left out",
    ]
    assert result.stderr.count("\n") == 2
    assert warnings.showwarning is before


def commands(command=main, path=()):
    """Yield the words and the command of all commands, subcommands included."""
    with click.Context(main) as context:
        for name in command.list_commands(context):
            each = command.get_command(context, name)
            yield (*path, name), each
            if isinstance(each, click.Group):
                yield from commands(each, (*path, name))


def options(command):
    return {option for param in command.params for option in param.opts}


def test_hints_name_options_that_exist():
    known = {option for _, command in commands() for option in options(command)}
    for hint in HINTS.values():
        assert {word.strip(",.;:'()") for word in hint.split() if word.startswith("--")} <= known, hint


def test_hints_are_for_codes_that_exist(repository):
    files = [*(repository / "uplift").rglob("*.py"), *(repository / "cli").rglob("*.py")]
    sources = "".join(path.read_text(encoding="utf-8") for path in files if path.name != "hints.py")
    assert [code for code in HINTS if f'"{code}"' not in sources] == []


def test_command_line_is_importable_only_by_its_installed_name(repository):
    importlib.import_module("uplift_cli")
    done = subprocess.run([sys.executable, "-c", "import cli"], cwd=repository, capture_output=True, text=True)
    assert done.returncode == 1
    assert "ImportError: the command line is installed as 'uplift_cli'" in done.stderr


FORBIDDEN = {"echo", "secho", "print", "Console", "Table"}
"""Names that may be called in the modules below only, which make texts safe for a terminal."""
DOORS = ("console.py", "tables.py", "progress.py")


def calls(tree):
    """Return the names that a module calls."""
    found = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return {each.attr if isinstance(each, ast.Attribute) else getattr(each, "id", "") for each in found}


def test_text_reaches_the_terminal_through_one_door(repository):
    for path in (repository / "cli").rglob("*.py"):
        if path.name not in DOORS:
            assert not calls(ast.parse(path.read_text(encoding="utf-8"))) & FORBIDDEN, path
    assert {"echo", "Table"} <= calls(ast.parse("click.echo(1)\nx = Table()"))
