"""Errors and warnings of the library on standard error."""

from __future__ import annotations

from typing import Any

import click

from uplift.common.errors import UpliftError, UpliftWarning

from .console import emit, json_text
from .hints import describe, hint_for


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
            text = json_text({"error": error_object(self.error)}, indent=None)
        else:
            text = f"{click.style('error:', fg='red', bold=True)} {self.message}"
        emit(text, err=True)


def error_object(error: UpliftError) -> dict[str, Any]:
    """Return an error as plain values for JSON, with the hint of the command line."""
    return error.to_json() | {"hint": hint_for(error)}


def show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    """Print warnings of the library on one line each, and no others; replaces `warnings.showwarning`."""
    if isinstance(message, UpliftWarning):
        emit(f"{click.style('warning:', fg='yellow', bold=True)} {describe(message)}", err=True)
