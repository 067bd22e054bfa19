"""Completion as bash shows it: keys typed into an interactive shell, names with spaces included."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

pexpect = pytest.importorskip("pexpect")

PROMPT, MARK = "ready> ", "<typed>"
SET_UP = """eval "$(_UPLIFT_COMPLETE=bash_source uplift)"; bind 'set bell-style none'; PS1='re''ady> '"""


# bash starts by fork and exec at once; JAX warns of its threads.
pytestmark = pytest.mark.filterwarnings(
    "ignore:os.fork\\(\\) was called:RuntimeWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)


@pytest.fixture
def shell(tmp_path):
    """An interactive bash in a folder with names that need quotes."""
    if shutil.which("bash") is None or not hasattr(pexpect, "spawn"):
        pytest.skip("needs bash and a pseudo-terminal")
    (tmp_path / "my cubes").mkdir()
    for name in ("my cubes/red paint.uplift", "blue paint.uplift", "babel fish.txt"):
        (tmp_path / name).touch()
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path, "TERM": "dumb", "HISTFILE": ""}
    terminal = pexpect.spawn(
        "bash", ["--norc", "--noprofile"], cwd=tmp_path, env=environment, encoding="utf-8", dimensions=(24, 200),
        timeout=60,
    )  # fmt: skip
    terminal.sendline(SET_UP)
    terminal.expect_exact(PROMPT)
    yield terminal
    terminal.close(force=True)


def completed(shell, line):
    """The command line after Tab."""
    shell.send(f"{line}\t{MARK}")
    shell.expect_exact(MARK)
    return shell.before


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("uplift info blue", r"uplift info blue\ paint.uplift "),
        ("uplift info 'blue", "uplift info 'blue paint.uplift' "),
        (r"uplift info blue\ p", r"uplift info blue\ paint.uplift "),
        ("uplift info my", r"uplift info my\ cubes/"),
        (r"uplift info my\ cubes/", r"uplift info my\ cubes/red\ paint.uplift "),
        (r"uplift build --space Adobe\ R", r"uplift build --space Adobe\ RGB\ \(1998\) "),
        ("uplift build --atlas macb", "uplift build --atlas macbeth "),
        ("uplift build --atlas babel", "uplift build --atlas babel"),  # the atlas babelcolor, and the file
        (r"uplift build --atlas babel\ ", r"uplift build --atlas babel\ fish.txt "),
        ("uplift build --ran", "uplift build --range "),
    ],
)
def test_bash_completes_and_quotes(shell, line, expected):
    assert completed(shell, line) == expected
