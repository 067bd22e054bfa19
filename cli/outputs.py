"""Files that a command writes: compared with all that it reads, before it computes anything."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from uplift.common import files
from uplift.common.errors import StrPath

from .options import OutputFile
from .output.console import say

Paths = Iterable[StrPath | None]


def check_outputs(*paths: StrPath | None, inputs: Paths = ()) -> None:
    """Check that files can be written, are not there without ``--force``, and are not read by the current command.

    It reads the files that its parameters name, and further ``inputs``, which patterns or files name. None are left
    out.
    """
    files.check_outputs(paths, inputs=[*_stated_inputs(), *inputs], force=_is_forced())


def check_folder(path: StrPath, names: Sequence[str], inputs: Paths = ()) -> Path:
    """Check the files of a folder as `check_outputs`, and that PNG can be drawn; `write_files` creates the folder."""
    if any(name.endswith(".png") for name in names):
        from uplift.viz.figure import matplotlib

        matplotlib()
    return files.check_folder(path, names, inputs=[*_stated_inputs(), *inputs], force=_is_forced())


def write_files(folder: Path, names: Sequence[str], *writers: Callable[..., None]) -> None:
    """Write the files of a folder, and print their names to standard error."""
    files.make_folder(folder)
    for name, write in zip(names, writers, strict=True):
        write(folder / name, force=_is_forced())
    say(f"{folder}: {', '.join(names)}", err=True)


def _is_forced() -> bool:
    return bool(click.get_current_context().params["force"])


def _stated_inputs() -> Iterator[str]:
    """Yield the texts of all parameters but outputs: those that name no file do no harm."""
    context = click.get_current_context()
    for param in context.command.params:
        if not isinstance(param.type, OutputFile):
            yield from _texts(context.params.get(str(param.name)))


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from _texts(part)
