"""The import contracts of pyproject.toml hold, and violations of them are detected."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

LINT = "from importlinter.cli import lint_imports_command; lint_imports_command()"


def lint(folder):
    """Run the linter on the packages of ``folder``."""
    code = f"import sys; sys.path[:0] = [{str(folder)!r}]; {LINT}"
    command = [sys.executable, "-c", code, "--no-cache"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8")
    return done.returncode, done.stdout + done.stderr


@pytest.fixture
def copied_code(repository, tmp_path) -> Path:
    """A copy of the code to modify, with the command line under its installed name."""
    shutil.copytree(repository / "uplift", tmp_path / "uplift", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(repository / "cli", tmp_path / "uplift_cli", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(repository / "pyproject.toml", tmp_path)
    return tmp_path


def test_the_contracts_hold(repository):
    code, text = lint(repository)
    assert code == 0, text
    assert "0 broken" in text


@pytest.mark.parametrize(
    ("module", "line", "contract"),
    [
        ("uplift/lookup/cube.py", "from uplift.io import texture", "Data flows one way"),
        ("uplift/report/page.py", "import uplift_cli.output.console", "Data flows one way"),
        ("uplift/lookup/cube.py", "import jax", "A lookup starts in the time that numpy takes"),
        ("uplift/models/sigmoid.py", "import colour", "One place reads colour-science's tables"),
        ("uplift/pipeline/build.py", "import click", "Only the command line knows click and rich"),
        ("uplift/lattice/lattice.py", "import uplift.lattice.entry_boxes", "No import cycles"),
        ("uplift/fit/seeds.py", "from uplift.viz import figure", "The core imports nothing above it"),
    ],
)
def test_violations_are_detected(copied_code, module, line, contract):
    with (copied_code / module).open("a", encoding="utf-8") as file:
        file.write(f"\n\ndef broken():\n    {line}\n")
    code, text = lint(copied_code)
    assert code == 1
    assert f"{contract} BROKEN" in text
