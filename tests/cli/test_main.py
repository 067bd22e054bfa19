"""What all commands share: help, exit codes, one line an error."""

from __future__ import annotations

import importlib
import subprocess
import sys
import warnings

import pytest
from click.testing import CliRunner
from uplift_cli.main import COMMANDS, main

import uplift
from uplift.common.errors import UpliftError, UpliftWarning


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_s_help_has_a_sentence_and_examples(run, name):
    usage, sentence, *rest = run(name, "--help").stdout.split("\n\n")
    assert usage.startswith(f"Usage: main {name} ")
    assert sentence.strip().endswith(".")
    (examples,) = [part for part in rest if part.startswith("  Examples:\n")]
    assert all(f"uplift {name} " in line for line in examples.splitlines()[1:])


def test_h_is_help(run):
    assert run("query", "-h").stdout == run("query", "--help").stdout


def test_the_group_s_own_help_has_examples():
    examples = main.help.split("\b\n")[1].split("\n\n")[0].splitlines()
    assert examples[0].strip() == "Examples:"
    assert all(line.strip().startswith("uplift ") for line in examples[1:])


def test_the_version_is_the_package_s(run):
    assert run("--version").stdout == f"uplift {uplift.__version__}\n"


@pytest.mark.parametrize(
    "args",
    [
        ("paint",),
        ("--nosuch",),
        ("query", "--nosuch"),
        ("query",),
        ("check",),
        ("build", "--dim", "many"),
        ("query", "--format", "xml", "#fff"),
        ("query", "--mode", "exact", "#fff"),
        ("info", "a", "b"),
    ],
)
def test_wrong_usage_is_click_s_error_with_code_2(run, args):
    result = run(*args, code=2)
    assert result.stdout == ""
    assert "Error: " in result.stderr
    assert "Traceback" not in result.stderr


def test_errors_of_the_library_are_one_line_with_code_2(monkeypatch, run):
    def fail(path):
        raise UpliftError("is bad", path="x", line=3, hint="make it good")

    monkeypatch.setattr("uplift.lookup.load", fail)
    result = run("info", "x", code=2)
    assert (result.stdout, result.stderr) == ("", "error: x:3: is bad; make it good\n")


def test_other_errors_are_not_hidden(monkeypatch, home):
    def fail(path):
        raise RuntimeError("a fault of ours")

    monkeypatch.setattr("uplift.lookup.load", fail)
    result = CliRunner().invoke(main, ["info", "x"])
    assert isinstance(result.exception, RuntimeError)


def test_warnings_of_the_library_are_one_line_each_and_others_none(monkeypatch, run):
    def load(path):
        warnings.warn("entry 'a' is left out", UpliftWarning, stacklevel=2)
        warnings.warn("entry 'a' is left out", UpliftWarning, stacklevel=2)
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.warn("internal", RuntimeWarning, stacklevel=2)
        return found

    found = uplift.load()
    monkeypatch.setattr("uplift.lookup.load", load)
    before = warnings.showwarning
    assert run("info").stderr == 2 * "warning: entry 'a' is left out\n"
    assert warnings.showwarning is before


def test_the_command_line_goes_by_its_installed_name_alone(repository):
    importlib.import_module("uplift_cli")
    done = subprocess.run(
        [sys.executable, "-c", "import cli"], cwd=repository, capture_output=True, text=True
    )
    assert done.returncode == 1
    assert "ImportError: the command line is installed as 'uplift_cli'" in done.stderr
