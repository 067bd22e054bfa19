"""Public names, a line each: commands, options and their values, exit codes, codes of
errors, versions of files, the Python reference with its parameters, and ``uplift.h``.

``make names`` adds new ones to tests/reference/public_names.txt. A line is removed by
hand only, after the release of warning that docs/project/compatibility.md promises.
"""

import importlib
import inspect
import json
import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import click
from uplift_cli.commands.help import EXIT_CODE_MEANINGS, find_context
from uplift_cli.main import main
from uplift_cli.replaced import REPLACED

from uplift.cube.file import KIND
from uplift.extras.emission.file import KIND as LIGHTS
from uplift.extras.export.source import read_source

ROOT = Path(__file__).parents[1]
STORED = ROOT / "tests" / "reference" / "public_names.txt"
CALL = re.compile(r"\b(uplift_[a-z_]+)\(|\b(UPLIFT_[A-Z_]+)\b")
"""A function or a constant in the declarations of ``uplift.h``."""


def public_names() -> list[str]:
    """Return the public names of this version, sorted."""
    with click.Context(main, info_name="uplift", **main.context_settings) as context:
        parts = (
            [f"exit code {code}" for code in EXIT_CODE_MEANINGS],
            [f"reads {KIND.format} {version}" for version in KIND.readable],
            [f"reads {LIGHTS.format} {version}" for version in LIGHTS.readable],
            _diagnostic_codes(),
            _header_names(),
            python_names(),
            command_names(main, context),
            _old_command_names(context),
        )
        return sorted(set(chain.from_iterable(parts)))


def _diagnostic_codes() -> Iterator[str]:
    path = ROOT / "docs" / "data" / "errors.json"
    for row in json.loads(path.read_text(encoding="utf-8"))["codes"]:
        yield f"{row['kind']} {row['code']}"


def _header_names() -> Iterator[str]:
    for function, constant in CALL.findall(read_source("runtime/head.h")):
        yield f"uplift.h {function or constant}"


def command_names(command: click.Command, context: click.Context) -> Iterator[str]:
    """Yield the words of a command and its subcommands, their arguments and options,
    and the values that an option takes.
    """
    path = context.command_path
    yield f"command {path}"
    for parameter in command.get_params(context):
        spellings = [*parameter.opts, *parameter.secondary_opts]
        if isinstance(parameter, click.Argument):
            spellings = [parameter.make_metavar(context)]
        for spelling in spellings:
            yield f"{path} {spelling}"
            for value in getattr(parameter.type, "choices", ()):
                yield f"{path} {spelling} {value}"
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            inner = command.get_command(context, name)
            assert inner is not None
            with click.Context(inner, info_name=name, parent=context) as below:
                yield from command_names(inner, below)


def _old_command_names(context: click.Context) -> Iterator[str]:
    """Yield the words of commands under the old names that still run."""
    for old, new in REPLACED.items():
        if " " not in old:
            command = find_context(new.split()).command
            with click.Context(command, info_name=old, parent=context) as below:
                yield from command_names(command, below)


def python_names() -> Iterator[str]:
    """Yield the names on the page of the Python API, with their parameters."""
    page = (ROOT / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    listed = re.findall(
        r"^\.\. automodule:: (\S+)(?:\n   :members: (.+))?$", page, re.MULTILINE
    )
    for package, members in listed:
        module = importlib.import_module(package)
        names = members.split(", ") if members else _exported(module)
        for name in names:
            yield from _described(f"{package}.{name}", getattr(module, name))


def _exported(module: Any) -> list[str]:
    """Return the names of a module that has an ``__all__``, or else those that it
    defines.
    """
    own = [
        name
        for name, value in vars(module).items()
        if not name.startswith("_")
        and getattr(value, "__module__", "") == module.__name__
    ]
    return list(getattr(module, "__all__", own))


def _described(name: str, value: Any) -> Iterator[str]:
    """Yield a name, its parameters, and the public members of a class."""
    yield name
    if inspect.isclass(value):
        for key, member in vars(value).items():
            if not key.startswith("_"):
                yield from _described(f"{name}.{key}", member)
        if getattr(value, "_is_protocol", False) or "__init__" not in vars(value):
            return
    if isinstance(value, classmethod | staticmethod):
        value = value.__func__
    if callable(value):
        for parameter in _parameters(value):
            if parameter not in ("self", "cls"):
                yield f"{name}({parameter})"


def _parameters(function: Any) -> Iterator[str]:
    """Yield the names of parameters, and of the keywords that ``**names`` unpacks."""
    for parameter in inspect.signature(function).parameters.values():
        keywords = re.fullmatch(r"Unpack\[(\w+)\]", str(parameter.annotation))
        if keywords is None:
            yield parameter.name
        else:
            module = importlib.import_module(function.__module__)
            yield from getattr(module, keywords[1]).__annotations__


def stored_names() -> list[str]:
    """Return the names of earlier versions and of this one when it was last stored."""
    return STORED.read_text(encoding="utf-8").splitlines()


if __name__ == "__main__":
    names = {*stored_names(), *public_names()} if STORED.exists() else public_names()
    STORED.write_text("".join(f"{name}\n" for name in sorted(names)), encoding="utf-8")
