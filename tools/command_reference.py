"""The reference of the command line: Markdown made from click's commands, for the
documentation site.
"""

import inspect
import re
import textwrap
from collections.abc import Iterator

import click
from uplift_cli.main import COMMANDS, main

VERBATIM = "\b\n"
"""Start of a paragraph that click does not wrap."""
PIPE = r"\|"
"""A vertical bar in a cell of a table."""


def command_reference() -> str:
    """Return the section of every group, command and subcommand in Markdown, in the
    order of the help.
    """
    parts = list[str]()
    with click.Context(main, info_name="uplift", **main.context_settings) as context:
        for name in COMMANDS:
            parts += _command(main.get_command(context, name), name, context)
    return "".join(parts)


def _command(
    command: click.Command | None, name: str, parent: click.Context
) -> Iterator[str]:
    """Yield the usage, the help and the options of a command, followed by its
    subcommands.
    """
    assert command is not None
    with click.Context(command, info_name=name, parent=parent) as context:
        usage = " ".join([context.command_path, *command.collect_usage_pieces(context)])
        yield f"\n## {context.command_path}\n\n```text\n{usage}\n```\n"
        for paragraph in inspect.cleandoc(
            (command.help or "").replace("\f\n", "")
        ).split("\n\n"):
            is_code = paragraph.startswith(VERBATIM)
            yield _code_block(paragraph) if is_code else f"\n{_escape(paragraph)}\n"
        yield "\n| option | |\n|---|---|\n"
        for each in command.get_params(context):
            option, text = each.get_help_record(context) or ("", "")
            if text:
                yield f"| `{option.replace('|', PIPE)}` | {_escape(text)} |\n"
        if isinstance(command, click.Group):
            for below in command.list_commands(context):
                inner = command.get_command(context, below)
                yield from _command(inner, below, context)


def _code_block(paragraph: str) -> str:
    """Format a paragraph that click prints as it stands; its first line may be a
    heading.
    """
    heading, *lines = paragraph.removeprefix(VERBATIM).splitlines()
    if not heading.endswith(":"):
        heading, lines = "", [heading, *lines]
    code = textwrap.dedent("\n".join(lines))
    return f"\n{_escape(heading)}\n\n```text\n{code}\n```\n"


def _escape(text: str) -> str:
    """Escape the characters that Markdown interprets, and set options as code."""
    escaped = re.sub(r"[\\`*_<>|~#\[]", lambda match: "\\" + match.group(), text)
    return re.sub(r"(?<![\w-])--[a-z][a-z-]*[a-z]", r"`\g<0>`", escaped)
