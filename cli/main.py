"""``uplift``: finds the command, runs it, and turns errors and warnings of the library into one line each."""

from __future__ import annotations

import errno
import importlib
import sys
import warnings
from typing import Any

import click

from uplift.common.errors import UpliftError, UpliftWarning

GROUPS = {
    "Cubes": ("build", "query", "texture", "mix", "export"),
    "What a cube holds, and what it is worth": ("info", "slices", "report", "check", "atlas"),
    "What a scene needs": ("plan", "wavelengths", "compare", "palette"),
    "Measurements": ("chart", "study"),
}
"""The commands by what they are for, as the help has them."""
COMMANDS = tuple(name for names in GROUPS.values() for name in names)
WHOLE = 200
"""Letters of a command's first sentence in the help: all of them."""
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""What a write says where there is no room."""


class Refusal(click.ClickException):
    """Bad input: one line, exit code 2."""

    exit_code = 2

    def show(self, file: Any = None) -> None:
        click.echo(f"{click.style('error:', fg='red', bold=True)} {self.message}", err=True)


class Commands(click.Group):
    """The commands, each imported when it is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in COMMANDS:
            return None
        command = importlib.import_module(f"uplift_cli.commands.{name}").command
        return command if isinstance(command, click.Command) else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        width = max(map(len, COMMANDS))
        for title, names in GROUPS.items():
            found = ((name, self.get_command(ctx, name)) for name in names)
            rows = [(f"{name:<{width}}", each.get_short_help_str(WHOLE)) for name, each in found if each]
            with formatter.section(title):
                formatter.write_dl(rows)

    def invoke(self, ctx: click.Context) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("always", UpliftWarning)
            warnings.showwarning = _show_warning
            try:
                done = super().invoke(ctx)
                sys.stdout.flush()  # what is left goes now, while errors can be told
            except UpliftError as error:
                raise Refusal(str(error)) from error
            except OSError as error:
                if error.errno not in FULL:
                    raise
                raise Refusal(f"standard output cannot be written: {error.strerror}; make room") from error
            return done


def _show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    if issubclass(category, UpliftWarning):
        click.echo(f"{click.style('warning:', fg='yellow', bold=True)} {message}", err=True)


@click.command(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="uplift", message="uplift %(version)s")
def main() -> None:
    """Spectral uplifting: from RGB to reflectance spectra, constrained by measured ones.

    \b
    Examples:
      uplift build --atlas atlases/macbeth.txt --dim 32
      uplift query --cube macbeth-32.uplift '#cc3319'
      uplift query 0.8 0.2 0.1 --format json
      uplift check cubes/*.uplift

    'uplift COMMAND --help' tells more.
    """
