"""Running the command line inside this process."""

import json
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result
from uplift_cli.main import main
from uplift_cli.output import progress
from uplift_cli.output.diagnostics import CommandFailure

from uplift.common.errors import UpliftError

Run = Callable[..., Result]


@pytest.fixture(scope="session", autouse=True)
def _no_progress() -> Iterator[None]:
    """Print no progress, however slow the machine is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(progress, "INTERVAL", 1e6)
        yield


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[CommandFailure]:
    """Errors of the library that were printed, in order."""
    errors: list[CommandFailure] = []
    show = CommandFailure.show

    def record(error: CommandFailure) -> None:
        errors.append(error)
        show(error)

    monkeypatch.setattr(CommandFailure, "show", record)
    return errors


@pytest.fixture
def run(home: Path) -> Run:
    """Run ``uplift`` with a line, which is split into words, and further arguments; any
    exception but an exit code is a failure.
    """

    def run(line: str = "", *args: object, code: int = 0, **options: object) -> Result:
        words = [*shlex.split(line), *map(str, args)]
        result = CliRunner().invoke(main, words, catch_exceptions=False, **options)  # type: ignore[arg-type]
        assert result.exit_code == code, result.output
        return result

    return run


@pytest.fixture
def ask(run: Run) -> Callable[..., Any]:
    """Run ``uplift`` with ``--format json`` and return the answer."""
    return lambda *args, **options: json.loads(
        run(*args, "--format", "json", **options).stdout
    )


@pytest.fixture
def refuse(run: Run, shown: list[CommandFailure]) -> Callable[..., UpliftError]:
    """Run ``uplift`` with bad input and return the error, reported on one line that has
    a hint or the constraint.
    """

    def refuse(*args: object, **options: object) -> UpliftError:
        result = run(*args, code=2, **options)
        assert result.stdout == ""
        failure = shown.pop()
        lines = result.stderr.splitlines()
        (line,) = [
            line for line in lines if not line.startswith(("warning: ", "note: "))
        ]
        assert line == f"error: {failure.message}"
        assert "; " in line or " must " in line
        assert failure.error.where in line
        return failure.error

    return refuse


@pytest.fixture
def misuse(run: Run, shown: list[CommandFailure]) -> Callable[..., str]:
    """Run ``uplift`` with options that do not fit together; return the message."""

    def misuse(*args: object, **options: object) -> str:
        result = run(*args, code=2, **options)
        assert result.stdout == ""
        assert not shown
        message = result.stderr.splitlines()[-1]
        assert message.startswith("error: ")
        return message

    return misuse


def commands(group: click.Group, path: str = "") -> dict[str, click.Command]:
    """Return all commands by their words, subcommands included."""
    found = {}
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        words = f"{path} {name}".strip()
        found[words] = command
        if isinstance(command, click.Group):
            found |= commands(command, words)
    return found


def warning_lines(result: Result) -> list[str]:
    """Return the warnings on standard error, without their prefix."""
    lines = result.stderr.splitlines()
    return [
        line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")
    ]


@pytest.fixture(scope="session")
def passes_text() -> str:
    """The file of two passes."""
    from uplift.extras.scene.passes.bands import PRESETS
    from uplift.extras.scene.passes.choice import fit_bands
    from uplift.extras.scene.passes.file import to_toml
    from uplift.extras.scene.passes.materials import library_materials

    bands = PRESETS[2]
    return to_toml(fit_bands(bands, library_materials(), ("D65", "A")))


@pytest.fixture
def cubes(repository: Path) -> Path:
    """The folder of stored cubes."""
    return repository / "cubes"


@pytest.fixture
def macbeth(repository: Path) -> Path:
    """The ColorChecker."""
    return repository / "atlases" / "macbeth.txt"
