"""The import contracts of pyproject.toml hold, and violations of them are detected."""

import subprocess
import sys

LINT = "from importlinter.cli import lint_imports_command; lint_imports_command()"


def lint(folder):
    """Run the linter on the packages of ``folder``."""
    code = f"import sys; sys.path[:0] = [{str(folder)!r}]; {LINT}"
    command = [sys.executable, "-c", code, "--no-cache"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8")
    return done.returncode, done.stdout + done.stderr


def test_the_contracts_hold(repository):
    code, text = lint(repository)
    assert code == 0, text
    assert "0 broken" in text
