"""``uplift``: find and run a command; print errors and warnings in a line each."""

import contextlib
import sys
import warnings
from typing import Any

import click

from uplift.common.errors import UpliftWarning
from uplift.common.extensions import installed
from uplift.common.version import version

from .command import LazyGroup
from .options import OUTPUT_FORMAT
from .output.console import emit, flush_stdout, say
from .output.diagnostics import (
    BAD_INPUT,
    FAILED_CHECK,
    INTERNAL_ERROR,
    CommandFailure,
    show_usage_error,
    show_warning,
)
from .replaced import current_words

COMMANDS = {
    "build": "Build a cube from measured spectra.",
    "query": "Query the spectrum of a colour.",
    "check": "Rebuild stored cubes and compare the results.",
    "slices": "Write the blue slices of a cube as images.",
    "chart": "Measure the speed and accuracy of upsampling methods.",
    "relight": "Show images under other lights, as RGB and as spectra.",
    "texture": "Convert images to spectral textures (OpenEXR).",
    "export": "Write a cube in a format that other tools read.",
    "atlas": "List the entries of atlas files.",
    "paints": "Mix, measure and match paints, dyes, filters and lights.",
    "passes": "Render spectra with an RGB renderer, in two or three passes.",
    "lights": "Give lights of any brightness spectral powers.",
    "plan": "Choose the cheapest spectra that a scene's tolerance allows.",
    "advise": "Name the colours of images to measure next.",
    "report": "Assess a cube: failures, errors, and every atlas entry.",
    "info": "Show the contents and provenance of a cube.",
    "samples": "Copy the files of the examples to a folder.",
    "lab": "Study models, and compare, bound and design spectra.",
    "help": "Explain a command or a topic, and list the topics.",
}
"""Summaries of the commands, the most frequent ones first."""
KIND = "commands"
"""Kind of the extensions that are commands of click."""


class Main(LazyGroup):
    """All commands, those of other packages included."""

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a command, of this package or another; None for an unknown name."""
        load = None if name in self.commands else installed(KIND).get(name)
        return super().get_command(ctx, name) if load is None else load()

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find a command, also by its old name, with a note unless there is ``-q``."""
        words = current_words(args)
        if words != args:
            count = len(words) - len(args) + 1
            loud = [word for word in words if word not in ("-q", "--quiet")]
            if loud == words and not ctx.resilient_parsing:
                new = " ".join(words[:count])
                say(f"note: 'uplift {args[0]}' is 'uplift {new}'", err=True)
            words = loud
        return super().resolve_command(ctx, words)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Refuse empty values, which an empty variable of a shell leaves: as the name
        of a folder they would be the current one.
        """
        joined = (arg for arg in args if arg.startswith("--"))
        if "" in args or any(arg.endswith("=") for arg in joined):
            raise click.UsageError("Values must not be empty.")
        return super().parse_args(ctx, args)

    def format_options(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the commands; the options are in the usage."""
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_dl(list(self.summaries.items()))
        outside = [
            (name, load().get_short_help_str())
            for name, load in installed(KIND).items()
        ]
        if outside:
            with formatter.section("Other packages"):
                formatter.write_dl(outside)

    def main(self, *args: Any, **options: Any) -> Any:
        """Run the command line and exit with a code of `uplift help exit-codes`."""
        code: Any
        try:
            code = super().main(*args, **options | {"standalone_mode": False})
            flush_stdout()  # help and version
        except CommandFailure as failure:
            failure.show()
            code = failure.exit_code
        except click.ClickException as error:
            show_usage_error(error)
            code = error.exit_code
        except click.Abort as interrupt:
            raise KeyboardInterrupt from interrupt
        except BrokenPipeError:
            code = FAILED_CHECK  # a closed pipe has the same code
        except OSError as error:
            CommandFailure(error).show()
            code = BAD_INPUT
        # what cannot be written is dropped: it is reported above
        with contextlib.suppress(OSError):
            flush_stdout()
        if options.get("standalone_mode", True):
            sys.exit(code if isinstance(code, int) else 0)
        return code

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; raise `CommandFailure` for any error in it."""
        with warnings.catch_warnings():
            warnings.simplefilter("always", UpliftWarning)
            warnings.showwarning = show_warning
            try:
                result = super().invoke(ctx)
                # a full disk must be noticed while errors can still be reported
                flush_stdout()
            except (
                click.ClickException,
                click.exceptions.Exit,
                click.Abort,
                BrokenPipeError,
            ):
                raise
            except (Exception, KeyboardInterrupt) as error:
                failure = CommandFailure(
                    error, as_json=ctx.meta.get(OUTPUT_FORMAT) == "json"
                )
                if failure.exit_code == INTERNAL_ERROR and ctx.params["traceback"]:
                    raise
                raise failure from error
            return result


def _show_version(ctx: click.Context, _: click.Parameter, is_requested: bool) -> None:
    if is_requested:
        emit(f"uplift {version()}")
        ctx.exit()


@click.command(
    cls=Main,
    summaries=COMMANDS,
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
    options_metavar="[--version] [--traceback]",
    help="Convert RGB colours to reflectance spectra that agree with measured ones.",
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_version,
    help="Show the version and exit.",
)
@click.option(
    "--traceback",
    is_flag=True,
    envvar="UPLIFT_TRACEBACK",
    help="Show the traceback of an internal error.",
)
def main(traceback: bool) -> None:
    """Hold the subcommands."""
