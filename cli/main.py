"""``uplift``: find the command, run it, and print errors and warnings on one line each."""

from __future__ import annotations

import difflib
import errno
import importlib
import signal
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

import click
from click.shell_completion import add_completion_class

from uplift.common.errors import OutputError, UpliftError, UpliftWarning
from uplift.common.version import VERSION

from .bash_completion import QuotingBashComplete
from .output.diagnostics import (
    InternalFailure,
    InterruptFailure,
    UsageFailure,
    show_usage_error,
    show_warning,
)
from .output.help_text import HelpFormatter
from .output.streams import finish_stdout, prepare_streams
from .params.options import OUTPUT_FORMAT
from .signals import check, end, ending_signals, received
from .startup import draw_without_window, hide_drawing_notes

GROUPS = {
    "First steps": ("relight", "samples"),
    "Cubes": ("build", "query", "bounds", "texture", "mix", "export", "lights"),
    "Inspection": ("info", "slices", "report", "check", "atlas"),
    "Scenes": ("plan", "wavelengths", "compare", "palette"),
    "Measurements": ("chart", "study"),
}
"""Commands by headings of the help."""
COMMANDS = tuple(name for names in GROUPS.values() for name in names)
HELP = "help"
"""Command that prints topics of the help."""
QUICK = "query"
"""The command that should start fast."""
SUMMARY_LENGTH = 200
"""Characters of a command's summary in the help; enough for all of them."""
LOST_PIPE = 1
"""Exit code of a command whose reader closed the pipe."""
DISK_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


click.Context.formatter_class = HelpFormatter  # contexts of subcommands are of click's own class


class LazyGroup(click.Group):
    """Commands in groups, each imported when it is needed."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, in the order of the help."""
        return [*COMMANDS, HELP]

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a command; None for an unknown name."""
        if name not in (*COMMANDS, HELP):
            return None
        if name not in (QUICK, HELP):
            hide_drawing_notes()
        command: click.Command = importlib.import_module(f"uplift_cli.commands.{name}").command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command of the arguments. Raises click's error, with similar names, for an unknown one."""
        name = args[0]
        if name.startswith("-") or ctx.resilient_parsing or self.get_command(ctx, name) is not None:
            return super().resolve_command(ctx, args)
        near = difflib.get_close_matches(name, self.list_commands(ctx), n=1)
        suggestion = f" Did you mean '{near[0]}'?" if near else ""
        raise click.UsageError(f"No such command '{name}'.{suggestion}", ctx)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write a section of the help for each group."""
        width = max(map(len, COMMANDS))
        for title, names in GROUPS.items():
            commands = ((name, self.get_command(ctx, name)) for name in names)
            rows = [(f"{name:<{width}}", each.get_short_help_str(SUMMARY_LENGTH)) for name, each in commands if each]
            with formatter.section(title):
                formatter.write_dl(rows)

    def main(self, *args: Any, **options: Any) -> Any:
        """Run the command line and exit.

        The exit code is 0 for success, 1 for a failed check or a closed pipe, 2 for bad input, and 70 for an internal
        error. A signal ends the process as it would end others: shells report 128 and its number.
        """
        add_completion_class(QuotingBashComplete)
        run: Callable[[], Any] = partial(super().main, *args, **options | {"standalone_mode": False})
        if not options.get("standalone_mode", True):
            return run()
        prepare_streams()
        draw_without_window()
        with ending_signals():
            code = _exit_code(run)
        return end(code)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; raise `UsageFailure` for errors of the library."""
        with warnings.catch_warnings(), _failures(ctx):
            warnings.simplefilter("always", UpliftWarning)
            warnings.showwarning = show_warning
            result = super().invoke(ctx)
            check()
            finish_stdout()  # a full disk must be noticed while errors can still be reported
            return result


def _exit_code(run: Callable[[], Any]) -> int:
    """Run, report what fails on one line, and return the exit code."""
    try:
        result = _result(run)
        finish_stdout()  # help and version
        return result if isinstance(result, int) else 0
    except UsageFailure as failure:
        return _report(failure)
    except click.ClickException as error:
        show_usage_error(error)
        return error.exit_code
    except (click.Abort, KeyboardInterrupt) as interrupt:
        return _report(InterruptFailure(interrupt, received() or signal.SIGINT))
    except BrokenPipeError:  # the reader closed the pipe
        return LOST_PIPE
    except OSError as error:
        return _report(UsageFailure(_system_error(error)))
    finally:
        with suppress(OSError):
            finish_stdout()


def _result(run: Callable[[], Any]) -> Any:
    try:
        return run()
    except SystemExit as end:
        return end.code


def _report(failure: UsageFailure) -> int:
    failure.show()
    return failure.exit_code


@contextmanager
def _failures(ctx: click.Context) -> Iterator[None]:
    """Turn errors of the library and of the system, and internal errors into `UsageFailure`."""
    as_json = partial(_is_json, ctx)
    try:
        yield
    except KeyboardInterrupt as interrupt:
        number = received() or signal.SIGINT
        raise InterruptFailure(interrupt, number, as_json=as_json()) from interrupt
    except UpliftError as error:
        if ended := received():  # workers may end before this process
            raise InterruptFailure(error, ended, as_json=as_json()) from error
        raise UsageFailure(error, as_json=as_json()) from error
    except BrokenPipeError:
        raise
    except OSError as error:
        raise UsageFailure(_system_error(error), as_json=as_json()) from error
    except MemoryError as error:
        raise UsageFailure(_memory_error(), as_json=as_json()) from error
    except (click.ClickException, click.exceptions.Exit, click.Abort):
        raise
    except Exception as error:
        if ended := received():  # an exception of JAX that was a KeyboardInterrupt
            raise InterruptFailure(error, ended, as_json=as_json()) from error
        if "RESOURCE_EXHAUSTED" in str(error):  # of JAX
            raise UsageFailure(_memory_error(), as_json=as_json()) from error
        if ctx.params["traceback"]:
            raise
        raise InternalFailure(error, as_json=as_json()) from error


def _is_json(ctx: click.Context) -> bool:
    return ctx.meta.get(OUTPUT_FORMAT) == "json"


def _system_error(error: OSError) -> UpliftError:
    """Return the error of the library for one of the system that it does not translate."""
    reason = error.strerror or str(error)
    if error.errno in DISK_FULL:
        problem = f"standard output cannot be written: {reason}"
        return OutputError(problem, code="disk-full", hint="free some space")
    if error.errno == errno.EBADF:
        problem = "standard output cannot be written: it is closed"
        return OutputError(problem, code="output-closed", hint="leave standard output open")
    path = error.filename if isinstance(error.filename, str) else None
    return OutputError(reason, code="system-error", path=path, hint="check the path and its permissions")


def _memory_error() -> UpliftError:
    return UpliftError("not enough memory", code="out-of-memory", hint="use a smaller input, or more memory")


@click.command(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(version=VERSION, message="uplift %(version)s")
@click.option("--traceback", is_flag=True, envvar="UPLIFT_TRACEBACK", help="Show the traceback of an internal error.")
def main(traceback: bool) -> None:
    """Convert RGB colours to reflectance spectra that agree with measured ones.

    \b
    Examples:
      uplift relight
      uplift build --atlas macbeth --dim 32
      uplift query --cube macbeth-32.uplift '#cc3319'
      uplift query 0.8 0.2 0.1 --format json
      uplift check macbeth-32.uplift

    'uplift COMMAND --help' describes a command and all of its options, 'uplift help' lists further topics.
    """
