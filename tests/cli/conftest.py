"""The command line as a user meets it, in this process."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from uplift_cli.main import main

from ..conftest import ROOT

MACBETH = str(ROOT / "atlases" / "macbeth.txt")
SMALL = str(ROOT / "cubes" / "moments-8-macbeth.uplift")
SIGMOID = str(ROOT / "cubes" / "sigmoid-8.uplift")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Commands run in an empty folder, and what they set for the process does not outlive them."""
    monkeypatch.chdir(tmp_path)
    for name in [name for name in os.environ if name.startswith("JAX_")]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path


@pytest.fixture
def run() -> Callable[..., Result]:
    """Run ``uplift`` with arguments; it must succeed."""

    def run(*arguments: object, stdin: str | bytes | None = None) -> Result:
        result = CliRunner().invoke(main, list(map(str, arguments)), input=stdin, catch_exceptions=False)
        assert result.exit_code == 0, result.stderr
        return result

    return run


@pytest.fixture
def refused() -> Callable[..., str]:
    """Run ``uplift`` with arguments; it must refuse in one line and exit with 2. The line is returned."""

    def refused(*arguments: object, stdin: str | bytes | None = None) -> str:
        result = CliRunner().invoke(main, list(map(str, arguments)), input=stdin, catch_exceptions=False)
        lines = [line for line in result.stderr.splitlines() if not line.startswith("warning:")]
        assert result.exit_code == 2
        assert result.stdout == ""
        assert len(lines) == 1
        assert lines[0].startswith("error: ")
        return lines[0]

    return refused
