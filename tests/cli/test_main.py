"""``uplift`` itself: help, version, and what a query costs."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.metadata import version

import pytest
from click.testing import CliRunner
from uplift_cli.main import COMMANDS, main

HEAVY = {"jax", "jaxlib", "optimistix", "equinox", "colour", "scipy", "matplotlib", "OpenEXR", "rich"}


def loaded_after(code):
    """Top-level modules that a fresh interpreter has loaded after ``code``."""
    program = f"import sys, io\n{code}\nprint(*sorted({{m.split('.')[0] for m in sys.modules}}), file=sys.__stdout__)"
    out = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return set(out.stdout.splitlines()[-1].split())


def test_help_names_every_command(run):
    text = run("--help").stdout
    for name in COMMANDS:
        assert f"\n  {name} " in text
    assert run("-h").stdout == text


def test_version(run):
    assert run("--version").stdout == f"uplift {version('uplift')}\n"


def test_an_unknown_command_is_refused_with_a_usage_line():
    result = CliRunner().invoke(main, ["biuld"])
    assert result.exit_code == 2
    assert "No such command 'biuld'" in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["query", "#cc3319", "--format", "json"],
        ["query", "0.1", "0.2", "0.3"],
        ["info", "--format", "json"],
        ["--help"],
    ],
)
def test_questions_load_neither_the_fit_nor_colour_science(arguments):
    code = f"from uplift_cli.main import main\ntry: main({arguments!r})\nexcept SystemExit as e: assert not e.code"
    assert not loaded_after(code) & HEAVY


def test_the_check_above_can_fail():
    assert "scipy" in loaded_after("import scipy")


def test_a_closed_pipe_is_no_error():
    command = f"{sys.executable} -m uplift_cli query '#cc3319' --format json | head -c 5"
    out = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert out.stdout == '{"rgb'
    assert out.stderr == ""


def test_it_runs_as_a_module():
    out = subprocess.run(
        [sys.executable, "-m", "uplift_cli", "query", "0", "0", "0", "--format", "json"],
        capture_output=True,
        check=True,
    )
    assert json.loads(out.stdout)["rgb"] == [0, 0, 0]


def test_the_source_folder_is_no_package_of_its_own():
    code = "import sys; sys.path.insert(0, '.'); import cli"
    out = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=__file__.rsplit("/tests/", 1)[0],
        check=False,
    )
    assert "installed as 'uplift_cli'" in out.stderr
