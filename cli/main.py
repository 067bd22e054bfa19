"""``uplift``: find and run a command; print errors and warnings in a line each."""

import contextlib
import importlib
import sys
import warnings
from itertools import chain
from typing import Any

import click

from uplift.common.errors import UpliftWarning
from uplift.common.extensions import installed
from uplift.common.version import version

from .command import Group
from .options import OUTPUT_FORMAT
from .output.console import emit, flush_stdout
from .output.diagnostics import (
    BAD_INPUT,
    FAILED_CHECK,
    INTERNAL_ERROR,
    CommandFailure,
    show_usage_error,
    show_warning,
)
from .startup import hide_drawing_notes

GROUPS = {
    "Every day": {
        "relight": "Show images under other lights, as RGB and as spectra.",
        "build": "Build a cube from measured spectra.",
        "query": "Query the spectrum of a colour.",
        "texture": "Convert images to spectral textures (OpenEXR).",
        "export": "Write a cube in a format that other tools read.",
        "report": "Assess a cube: failures, errors, and every atlas entry.",
    },
    "Cubes": {
        "info": "Show the contents and provenance of a cube.",
        "slices": "Write the blue slices of a cube as images.",
        "check": "Rebuild stored cubes and compare the results.",
        "diff": "Compare the answers of two cubes.",
    },
    "Materials": {
        "atlas": "List the entries of atlas files.",
        "bounds": "Compute the bounds of all reflectances of a colour.",
        "advise": "Name the colours of images to measure next.",
        "mix": "Mix colours as spectra: paints, dyes, filters, lights.",
        "paints": "Fit your own paints to measured samples, and find recipes.",
        "palette": "Design the unknown spectra of a palette.",
    },
    "Scenes and lights": {
        "plan": "Choose the cheapest spectra that a scene's tolerance allows.",
        "wavelengths": "Choose the wavelengths at which a renderer samples.",
        "passes": "Render spectra with an RGB renderer, in two or three passes.",
        "compare": "Compare representations of spectra by error and cost.",
        "lights": "Give lights of any brightness spectral powers.",
    },
    "Laboratory": {
        "chart": "Measure the speed and accuracy of upsampling methods.",
        "study": "Measure models, solver, and the propagation of errors.",
        "samples": "Copy the files of the examples to a folder.",
    },
}
"""Summaries of the commands by headings of the help."""
COMMANDS = tuple(chain.from_iterable(GROUPS.values()))
KIND = "commands"
"""Kind of the extensions that are commands of click."""
QUICK = ("build", "query", "help")
"""Commands that start without what drawing needs."""


class LazyGroup(Group):
    """Commands in groups, each imported when it is needed."""

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a command, of this package or another; None for an unknown name."""
        if name not in self.commands:
            load = installed(KIND).get(name)
            return None if load is None else load()
        if name not in QUICK:
            hide_drawing_notes()
        return importlib.import_module(f"uplift_cli.commands.{name}").command

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Refuse empty values, which an empty variable of a shell leaves: as the name
        of a folder they would be the current one.
        """
        joined = (arg for arg in args if arg.startswith("--"))
        if "" in args or any(arg.endswith("=") for arg in joined):
            raise click.UsageError("Values must not be empty.")
        return super().parse_args(ctx, args)

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write a section of the help for each group."""
        outside = {
            name: load().get_short_help_str() for name, load in installed(KIND).items()
        }
        groups = GROUPS | ({"Other packages": outside} if outside else {})
        width = max(map(len, chain(COMMANDS, outside)))
        for title, names in groups.items():
            with formatter.section(title):
                formatter.write_dl(
                    [(f"{name:<{width}}", summary) for name, summary in names.items()]
                )

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
    cls=LazyGroup,
    commands=[click.Command(name) for name in (*COMMANDS, "help")],
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
    help="""Convert RGB colours to reflectance spectra that agree with measured ones.

    \b
    Examples:
      uplift relight
      uplift build --atlas macbeth --dim 32
      uplift query --cube macbeth-32.uplift '#cc3319'
      uplift query 0.8 0.2 0.1 --format json
      uplift check macbeth-32.uplift

    'uplift help COMMAND' describes a command, and 'uplift help' lists further topics.
    """,
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
