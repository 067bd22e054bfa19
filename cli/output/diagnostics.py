"""Errors and warnings on standard error: one line each."""

from __future__ import annotations

import contextlib
import signal
from pathlib import Path
from typing import Any

import click

from uplift.common.errors import UpliftError, UpliftWarning
from uplift.common.text import printable

from .console import emit, json_text
from .hints import describe, hint_for

INTERNAL_ERROR = 70
"""Exit code of an error of uplift itself, EX_SOFTWARE of sysexits.h."""
MAX_DETAIL = 200
"""Characters of the message of an internal error."""


class UsageFailure(click.ClickException):
    """Bad input: one line on standard error and exit code 2.

    Parameters
    ----------
    error : UpliftError
        The error to report.
    as_json : bool
        Report it as JSON, for commands that run with ``--format json``.
    """

    exit_code = 2

    def __init__(self, error: UpliftError, *, as_json: bool = False) -> None:
        super().__init__(describe(error))
        self.error, self.as_json = error, as_json

    def show(self, file: Any = None) -> None:
        """Print the error to standard error."""
        if self.as_json:
            _print(json_text({"error": error_object(self.error)}, indent=None))
        else:
            _print_error(self.message)


class InternalFailure(UsageFailure):
    """An exception that uplift does not expect: one line on standard error and exit code 70."""

    exit_code = INTERNAL_ERROR

    def __init__(self, error: Exception, *, as_json: bool = False) -> None:
        import traceback  # slow to import, and rarely needed

        place = traceback.extract_tb(error.__traceback__)[-1:]
        where = "".join(f" in {Path(frame.filename).name}:{frame.lineno}" for frame in place)
        detail = " ".join(str(error).split())[:MAX_DETAIL]
        problem = f"internal error, please report it: {type(error).__name__}{where}" + (f": {detail}" if detail else "")
        report = UpliftError(problem, code="internal-error", hint="'uplift --traceback COMMAND …' shows more")
        super().__init__(report, as_json=as_json)


class InterruptFailure(UsageFailure):
    """A command that a signal ended: one line on standard error, with the notes of the exception.

    Parameters
    ----------
    interrupt : BaseException
        The exception that ended the command.
    number : int
        The signal.
    as_json : bool
        Report it as JSON.
    """

    def __init__(self, interrupt: BaseException, number: int, *, as_json: bool = False) -> None:
        hint = "; ".join(getattr(interrupt, "__notes__", ())) or "unfinished files are removed"
        problem = f"ended by {signal.Signals(number).name}"
        super().__init__(UpliftError(problem, code="interrupted", hint=hint), as_json=as_json)
        self.number = number

    @property
    def exit_code(self) -> int:  # type: ignore[override]
        """128 and the number of the signal, as shells report it."""
        return 128 + self.number


def show_usage_error(error: click.ClickException) -> None:
    """Print an error of the command line on one line, with the command that shows the help."""
    message = " ".join(error.format_message().split())
    context = getattr(error, "ctx", None)
    _print_error(printable(message) + (f" See '{context.command_path} --help'." if context else ""))


def error_object(error: UpliftError) -> dict[str, Any]:
    """Return an error as plain values for JSON, with the hint of the command line."""
    return error.to_json() | {"hint": hint_for(error)}


def show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    """Print warnings of the library on one line each, and no others; replaces `warnings.showwarning`."""
    if isinstance(message, UpliftWarning):
        _print(f"{click.style('warning:', fg='yellow', bold=True)} {describe(message)}")


def _print_error(text: str) -> None:
    _print(f"{click.style('error:', fg='red', bold=True)} {text}")


def _print(text: str) -> None:
    with contextlib.suppress(OSError):  # nowhere else is left to report it; the exit code shows that it failed
        emit(text, err=True)
