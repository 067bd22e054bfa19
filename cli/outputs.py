"""Files that a command writes, compared beforehand with all that it reads."""

from collections.abc import Callable, Iterable, Sequence

import click

from uplift.common.errors import StrPath
from uplift.extras.files import outputs

from .option_types import INPUTS, OutputFile
from .output.console import say

Paths = Iterable[StrPath | None]


def check_outputs(*paths: StrPath | None, inputs: Paths = ()) -> None:
    """Check that files can be written, are not there without ``--force``, and are not
    read by the current command.

    It reads the files that its parameters name, and further ``inputs``, which patterns
    or files name. None are left out.
    """
    outputs.check_outputs(paths, inputs=[*stated_inputs(), *inputs], force=_is_forced())


def check_folder(
    path: StrPath | None, names: Sequence[str], inputs: Paths = ()
) -> None:
    """Check the files of a folder as `check_outputs`, and that PNG can be drawn;
    `write_files` creates the folder.
    """
    if path is None:
        return
    if any(name.endswith(".png") for name in names):
        from uplift.extras.pages.figure import matplotlib

        matplotlib()
    outputs.check_folder(
        path, names, inputs=[*stated_inputs(), *inputs], force=_is_forced()
    )


def write_files(
    path: StrPath, names: Sequence[str], *writers: Callable[..., None]
) -> None:
    """Write the files of a folder, and print their names to standard error."""
    folder = outputs.make_folder(path)
    for name, write in zip(names, writers, strict=True):
        write(folder / name, force=_is_forced())
    say(f"{folder}: {', '.join(names)}", err=True)


def _is_forced() -> bool:
    return bool(click.get_current_context().params["force"])


def stated_inputs() -> list[str]:
    """Return the texts of all parameters but outputs, and files of lamps: those that
    name no file do no harm.
    """
    context = click.get_current_context()
    texts: list[str] = list(context.meta.get(INPUTS, ()))
    for param in context.command.params:
        if not isinstance(param.type, OutputFile):
            value = context.params.get(str(param.name))
            values = value if isinstance(value, tuple) else [value]
            texts += [text for text in values if isinstance(text, str)]
    return texts
