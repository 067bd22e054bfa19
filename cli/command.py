"""Commands and groups of commands: what their help shows, and negative numbers."""

import inspect
import re
import sys
from collections.abc import Collection, Mapping
from importlib import import_module
from typing import Any

import click

from .startup import hide_drawing_notes

NEGATIVE_NUMBER = re.compile(r"-\.?\d")
QUICK = ("build", "query", "help")
"""Commands that start without what drawing needs."""
HELP_ALL = "uplift.help-all"
"""Key of the context's ``meta`` while the whole help is printed."""


class Command(click.Command):
    """A command with many options, which reads '-0.1' as a number, not as an option.

    ``--help`` shows the options of every day, by the names of their parameters, and the
    text before a form feed. ``--help-all`` shows everything. ``no_arguments`` is stated
    where a command without arguments is given some.
    """

    def __init__(
        self,
        *args: Any,
        everyday: Collection[str],
        no_arguments: str = "",
        **settings: Any,
    ) -> None:
        super().__init__(*args, **settings)
        self.everyday = everyday
        self.no_arguments = no_arguments
        self.params.append(
            click.Option(
                ["--help-all"],
                is_flag=True,
                expose_value=False,
                help="Show all options.",
            )
        )

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Mark negative numbers by a leading space before parsing."""
        if "--help-all" in args:
            ctx.meta[HELP_ALL] = True
            args = ["--help"]
        try:
            return super().parse_args(
                ctx, [f" {arg}" if NEGATIVE_NUMBER.match(arg) else arg for arg in args]
            )
        except click.UsageError as error:
            if self.no_arguments and "extra argument" in error.message:
                raise click.UsageError(
                    f"{error.message}. {self.no_arguments}", ctx
                ) from error
            raise

    def format_help_text(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the text, after the form feed for --help-all only."""
        short, _, further = inspect.cleandoc(self.help or "").partition("\f")
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_text(short + further if HELP_ALL in ctx.meta else short)

    def format_options(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the options of every day, the last two of help, or all options."""
        params = self.get_params(ctx)
        shown = [option for option in params if isinstance(option, click.Option)]
        if HELP_ALL not in ctx.meta:
            names = (*self.everyday, *(option.name for option in shown[-2:]))
            shown = [option for option in shown if option.name in names]
        records = (option.get_help_record(ctx) for option in shown)
        with formatter.section("Options"):
            formatter.write_dl(list(filter(None, records)))


class Group(click.Group):
    """Commands under one name, which alone prints the help."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names in the order of the code."""
        return list(self.commands)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse ``--help`` in place of no arguments."""
        return super().parse_args(ctx, args or ["--help"])

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write names and first sentences, which click would cut to one line."""
        commands = (
            (name, self.get_command(ctx, name)) for name in self.list_commands(ctx)
        )
        records = [
            (name, command.get_short_help_str(limit=sys.maxsize))
            for name, command in commands
            if command
        ]
        with formatter.section("Commands"):
            formatter.write_dl(records)


class LazyGroup(Group):
    """Commands by name and summary, each imported when it is needed."""

    def __init__(
        self, name: str, summaries: Mapping[str, str], **settings: Any
    ) -> None:
        super().__init__(name, [click.Command(each) for each in summaries], **settings)
        self.summaries = summaries

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a command; None for an unknown name."""
        if name not in self.commands:
            return None
        if name not in QUICK:
            hide_drawing_notes()
        module = import_module(f"uplift_cli.commands.{name}")
        command: click.Command = module.command
        return command

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write names and summaries."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.summaries.items()))
