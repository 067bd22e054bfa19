"""``uplift``: find the command, run it, and print errors and warnings of the library on one line each."""

from __future__ import annotations

import errno
import importlib
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import click

from uplift.common.errors import OutputError, UpliftError, UpliftWarning

from .output.diagnostics import UsageFailure, show_warning
from .params.options import OUTPUT_FORMAT
from .params.renamed import renamed_option

GROUPS = {
    "Cubes": ("build", "query", "texture", "mix", "export"),
    "Inspection": ("info", "slices", "report", "check", "atlas"),
    "Scenes": ("plan", "wavelengths", "compare", "palette"),
    "Measurements": ("chart", "study"),
}
"""Commands by headings of the help."""
COMMANDS = tuple(name for names in GROUPS.values() for name in names)
SUMMARY_LENGTH = 200
"""Characters of a command's summary in the help; enough for all of them."""
DISK_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class LazyGroup(click.Group):
    """Commands in groups, each imported when it is needed."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, in the order of the help."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a command; None for an unknown name."""
        if name not in COMMANDS:
            return None
        command: click.Command = importlib.import_module(f"uplift_cli.commands.{name}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write a section of the help for each group."""
        width = max(map(len, COMMANDS))
        for title, names in GROUPS.items():
            commands = ((name, self.get_command(ctx, name)) for name in names)
            rows = [
                (f"{name:<{width}}", each.get_short_help_str(SUMMARY_LENGTH))
                for name, each in commands
                if each
            ]
            with formatter.section(title):
                formatter.write_dl(rows)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; raise `UsageFailure` for errors of the library."""
        with warnings.catch_warnings(), _usage_failures(ctx):
            warnings.simplefilter("always", UpliftWarning)
            warnings.showwarning = show_warning
            result = super().invoke(ctx)
            sys.stdout.flush()  # a full disk must be noticed while errors can still be reported
            return result


@contextmanager
def _usage_failures(ctx: click.Context) -> Iterator[None]:
    """Turn errors of the library, full disks and renamed options into `UsageFailure`."""
    try:
        yield
    except UpliftError as error:
        raise _failure(ctx, error) from error
    except OSError as error:
        if error.errno not in DISK_FULL:
            raise
        problem = f"standard output cannot be written: {error.strerror}"
        raise _failure(ctx, OutputError(problem, code="disk-full", hint="free some space")) from error
    except click.NoSuchOption as error:
        renamed = renamed_option(error)
        if renamed is None:
            raise
        raise _failure(ctx, renamed) from error


def _failure(ctx: click.Context, error: UpliftError) -> UsageFailure:
    return UsageFailure(error, as_json=ctx.meta.get(OUTPUT_FORMAT) == "json")


@click.command(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="uplift", message="uplift %(version)s")
def main() -> None:
    """Convert RGB colours to reflectance spectra that agree with measured ones.

    \b
    Examples:
      uplift build --atlas macbeth --dim 32
      uplift query --cube macbeth-32.uplift '#cc3319'
      uplift query 0.8 0.2 0.1 --format json
      uplift check cubes/*.uplift

    'uplift COMMAND --help' describes a command and all of its options.
    """
