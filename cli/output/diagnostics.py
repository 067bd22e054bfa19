"""Errors and warnings on standard error, with hints in terms of options."""

import contextlib
import os
import re
import signal
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from uplift.common.errors import (
    CubeFileError,
    Diagnostic,
    OptionError,
    OutputError,
    UpliftError,
    UpliftWarning,
)
from uplift.common.text import printable
from uplift.common.version import outdated_package

from ..replaced import REPLACED
from ..startup import remove_compiled_code
from .console import emit, json_text

FAILED_CHECK = 1
BAD_INPUT = 2
INTERNAL_ERROR = 70
"""Exit codes; 70 is EX_SOFTWARE of sysexits.h."""
EXIT_CODES = {"internal-error": INTERNAL_ERROR, "interrupted": 128 + signal.SIGINT}
"""Exit codes by code of the error."""
MAX_DETAIL = 200
"""Characters of the message of an internal error."""
HINTS = {
    "atlas-out-of-gamut": (
        "use --scale percent if the values are in percent, or else a wider --space"
    ),
    "atlas-changed": (
        "name the folder of the recorded file with --atlas-dir, or build the cube again"
    ),
    "atlas-not-found": "name its folder with --atlas-dir, or build the cube again",
    "colour-not-a-light": (
        "use --out-of-gamut clip for the nearest colour towards white"
    ),
    "colour-not-in-scene": (
        "use --fill-missing, or build the cube with the image in --scene"
    ),
    "entry-skipped": "'uplift atlas' states the reason for each",
    "invalid-codes": "leave out --encoded for linear floats",
    "scale-not-stated": (
        "use --scale percent, or --scale fraction for values from 0 to 1"
    ),
    "scales-contradict": (
        "use --scale percent, or --scale fraction for values from 0 to 1"
    ),
    "dark-percent": "use --scale fraction if they are from 0 to 1",
    "mixed-scales": (
        "correct the row, or use --scale percent or fraction if it is right"
    ),
    "not-a-cube": (
        "'uplift build --atlas FILE' makes one of spectra, and 'uplift lights' reads "
        "emission tables"
    ),
    "not-an-emission-table": (
        "build one with 'uplift lights build', or use 'uplift query' and the like "
        "for a cube"
    ),
    "not-spectra": (
        "an atlas is a table (CSV, text, spreadsheet), CGATS, CxF3, TM-27, JCAMP-DX, "
        "an ENVI library or an ART archive; a cube is used with --cube, an image with "
        "'uplift texture' and 'uplift relight'"
    ),
    "rgb-like-codes": (
        "write 8-bit codes as '#rrggbb', or use --encoded where the command has it"
    ),
    "rgb-out-of-gamut": "map it inside with --out-of-gamut desaturate",
    "sparse-cube": (
        "use --fill-missing where the command has it, or a cube built without --scene"
    ),
    "texture-differs": (
        "use --resume with --force to convert the image again, or choose another name"
    ),
}
"""Hints in place of the library's, by the code of an error or a warning."""
IN_COMMANDS = {
    "an emission table": "'uplift lights texture'",
    "read_lamps()": "'uplift lights' and as --light FILE",
    "shipped_atlases()": "'uplift atlas'",
    "tables.names('RGB space')": "'uplift help spaces'",
    "tables.names('camera')": "'uplift help observers'",
    "tables.names('illuminant')": "'uplift help illuminants'",
    "tables.names('observer')": "'uplift help observers'",
}
"""Commands in place of what hints of the library name."""
PARAMETER = re.compile(r"""(?<![\w'"-])([a-z_]+)=(True|[\w.]+|'[^']*'|"[^"]*")""")
"""A parameter of Python and its value."""
QUOTES = "'\""
MEMORY_PROBLEMS = ("RESOURCE_EXHAUSTED", "failed to map segment")
"""Texts of JAX and of the loader of libraries without memory."""


def hint_for(diagnostic: Diagnostic) -> str:
    """Return the hint of the command line for an error or warning, or else the
    library's own in its terms.
    """
    if isinstance(diagnostic, CubeFileError) and diagnostic.code == "file-not-found":
        return _hint_of_missing_cube(str(diagnostic.path)) or diagnostic.hint
    if diagnostic.code in HINTS:
        return HINTS[diagnostic.code]
    hint = PARAMETER.sub(_as_option, diagnostic.hint)
    for function, command in IN_COMMANDS.items():
        hint = hint.replace(function, command)
    return hint


def _as_option(parameter: re.Match[str]) -> str:
    """Return ``--name value`` for ``name=value``, and ``--name`` for ``name=True``."""
    name, value = parameter.groups()
    option = "--" + name.replace("_", "-")
    return option if value == "True" else f"{option} {value.strip(QUOTES)}"


def _hint_of_missing_cube(path: str) -> str:
    """Return how the cube of a name is built, or a file of nearly this name; empty
    where neither is known.
    """
    from uplift.atlas.sources import shipped_atlases

    if os.path.isfile(f"{path}.uplift"):
        return f"did you mean {path}.uplift?"
    match = re.fullmatch(r"(.+?)(?:-(\d+))?(?:\.uplift)?", os.path.basename(path))
    if match is None or match[1] not in [
        atlas.path.stem for atlas in shipped_atlases()
    ]:
        return ""
    dim = f" --dim {match[2]}" if match[2] else ""
    return (
        f"'{match[1]}' is an atlas: build its cube with 'uplift build --atlas "
        f"{match[1]}{dim}'"
    )


class CommandFailure(click.ClickException):
    """An exception that ended a command, as one line on standard error and an exit
    code; JSON if ``as_json``.
    """

    def __init__(self, cause: BaseException, *, as_json: bool = False) -> None:
        self.error = _as_uplift_error(cause)
        self.as_json = as_json
        super().__init__(self.error.describe(hint_for(self.error)))

    @property
    def exit_code(self) -> int:  # type: ignore[override]
        """2 for bad input, 70 for an internal error, 130 after Ctrl-C."""
        return EXIT_CODES.get(self.error.code, BAD_INPUT)

    def show(self, file: Any = None) -> None:
        """Print the error to standard error."""
        if self.as_json:
            _print(json_text({"error": error_object(self.error)}, indent=None))
        else:
            _print_error(self.message)


def _as_uplift_error(cause: BaseException) -> UpliftError:
    if isinstance(cause, UpliftError):
        return cause
    if isinstance(cause, KeyboardInterrupt):
        hint = (
            "; ".join(getattr(cause, "__notes__", ())) or "unfinished files are removed"
        )
        return UpliftError("interrupted", code="interrupted", hint=hint)
    if isinstance(cause, MemoryError) or any(
        text in str(cause) for text in MEMORY_PROBLEMS
    ):
        return UpliftError(
            "not enough memory",
            code="out-of-memory",
            hint="use a smaller input, or more memory",
        )
    if isinstance(cause, OSError):
        path = cause.filename if isinstance(cause.filename, str) else None
        problem = cause.strerror or str(cause)
        hint = "check the path, its permissions and the free space"
        return OutputError(
            problem if path else f"output cannot be written: {problem}",
            path=path,
            hint=hint,
        )
    return _internal_error(cause)


def _internal_error(cause: BaseException) -> UpliftError:
    import traceback  # slow to import, and rarely needed

    place = traceback.extract_tb(cause.__traceback__)[-1:]
    if place and Path(place[0].filename).name == "xla_bridge.py":
        problem = (
            "JAX finds no device for "
            f"JAX_PLATFORMS={printable(os.environ.get('JAX_PLATFORMS', ''))}"
        )
        return OptionError(
            problem, hint="unset JAX_PLATFORMS, or install JAX for this device"
        )
    with contextlib.suppress(ImportError):  # of the metadata of uplift
        if outdated := outdated_package():
            hint = "upgrade it: pip install --upgrade spectral-uplift"
            return UpliftError(outdated, code="package-too-old", hint=hint)
    where = "".join(
        f" in {Path(frame.filename).name}:{frame.lineno}" for frame in place
    )
    detail = " ".join(str(cause).split())[:MAX_DETAIL]
    problem = f"internal error, please report it: {type(cause).__name__}{where}" + (
        f": {detail}" if detail else ""
    )
    hint = "'uplift --traceback COMMAND …' shows more"
    if "jax" in sys.modules and remove_compiled_code():
        hint = (
            "try again first: compiled code, which may have been damaged, was "
            f"removed; {hint}"
        )
    return UpliftError(problem, code="internal-error", hint=hint)


def error_object(error: UpliftError) -> dict[str, Any]:
    """Return an error as plain values for JSON, with the hint of the command line."""
    return error.to_json() | {"hint": hint_for(error)}


def show_usage_error(error: click.ClickException) -> None:
    """Print an error of the command line, with the command that shows the help."""
    message = " ".join((_renaming(error) or error.format_message()).split())
    context = getattr(error, "ctx", None)
    _print_error(
        printable(message)
        + (f" See '{context.command_path} --help'." if context else "")
    )


def _renaming(error: click.ClickException) -> str:
    """Return what replaces an unknown option, if it is one of version 0.2."""
    if not isinstance(error, click.NoSuchOption) or error.ctx is None:
        return ""
    command = error.ctx.command_path.partition(" ")[2]
    new = REPLACED.get(f"{command} {error.option_name}", "")
    return new and f"No such option '{error.option_name}': {new} replaces it."


def warn(notes: Iterable[UpliftWarning]) -> None:
    """Emit warnings that the library returned as data."""
    for note in notes:
        warnings.warn(note, stacklevel=1)


def show_warning(
    message: Warning | str, category: type[Warning], *_: Any, **__: Any
) -> None:
    """Print warnings of the library on one line each, and no others; replaces
    `warnings.showwarning`.
    """
    if str(message).startswith("Error reading persistent compilation cache entry"):
        remove_compiled_code()
    if isinstance(message, UpliftWarning):
        text = message.describe(hint_for(message))
        _print(f"{click.style('warning:', fg='yellow', bold=True)} {text}")


def _print_error(text: str) -> None:
    _print(f"{click.style('error:', fg='red', bold=True)} {text}")


def _print(text: str) -> None:
    # nowhere else is left to report it; the exit code shows that it failed
    with contextlib.suppress(OSError):
        emit(text, err=True)
