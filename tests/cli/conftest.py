"""Running the command line inside this process."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from uplift_cli.main import main

Run = Callable[..., Result]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder; what JAX compiles is kept there too, not in the user's cache."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path.parent / "compiled"))
    for name in ("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES"):
        monkeypatch.setenv(name, "0")
    return tmp_path


@pytest.fixture
def run(home: Path) -> Run:
    """Run ``uplift`` with arguments; anything but an exit code is a failure."""

    def run(*args: object, code: int = 0, **options: object) -> Result:
        result = CliRunner().invoke(main, [str(arg) for arg in args], catch_exceptions=False, **options)  # type: ignore[arg-type]
        assert result.exit_code == code, result.output
        return result

    return run


@pytest.fixture
def refuse(run: Run) -> Callable[..., str]:
    """Run ``uplift`` with bad input; the one line it says: what is wrong, and what to do."""

    def refuse(*args: object, **options: object) -> str:
        result = run(*args, code=2, **options)
        assert result.stdout == ""
        errors = [line for line in result.stderr.splitlines() if not line.startswith("warning: ")]
        assert len(errors) == 1
        assert errors[0].startswith("error: ")
        assert "; " in errors[0]
        return errors[0].removeprefix("error: ")

    return refuse


@pytest.fixture
def cubes(repository: Path) -> Path:
    """The folder of stored cubes."""
    return repository / "cubes"


@pytest.fixture
def macbeth(repository: Path) -> Path:
    """The ColorChecker."""
    return repository / "atlases" / "macbeth.txt"
