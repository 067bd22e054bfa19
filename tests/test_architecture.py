"""The import contracts hold, and would not if someone broke them."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from .conftest import ROOT

LINT = Path(sys.executable).parent / "lint-imports"


def lint(folder):
    """import-linter on the packages of ``folder``, whatever is installed."""
    shutil.copytree(folder / "cli", folder / "uplift_cli", dirs_exist_ok=True)
    code = (
        "import sys; sys.path.insert(0, '.')\n"
        "from importlinter.cli import lint_imports\n"
        "sys.exit(lint_imports(config_filename='pyproject.toml', no_cache=True))"
    )
    return subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=False
    )


@pytest.fixture
def copy(tmp_path):
    for folder in ("uplift", "cli"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copyfile(ROOT / "pyproject.toml", tmp_path / "pyproject.toml")
    return tmp_path


def test_the_contracts_hold(copy):
    result = lint(copy)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize(
    ("module", "line", "contract"),
    [
        ("uplift/lookup/cube.py", "import jax", "A lookup starts in the time that numpy takes"),
        (
            "uplift/cube/data.py",
            "from uplift import observer",
            "A lookup starts in the time that numpy takes",
        ),
        ("uplift/models/phase.py", "from uplift import lattice", "Data flows one way"),
        ("uplift/report/summary.py", "import click", "Only the command line knows click and rich"),
        ("uplift/fit/seed.py", "import colour", "One place reads colour-science's tables"),
    ],
)
def test_a_broken_contract_is_found(copy, module, line, contract):
    path = copy / module
    path.write_text(path.read_text(encoding="utf-8") + f"\n{line}\n", encoding="utf-8")
    result = lint(copy)
    assert result.returncode != 0
    assert f"{contract} BROKEN" in result.stdout
