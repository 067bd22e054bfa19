"""Exception hierarchy: errors and warnings carry a stable code, the problem and, where
known, a place and a hint.
"""

import contextlib
import os
import sys
import warnings
from collections.abc import Iterable, Iterator
from typing import Any

from uplift.common.text import listed, printable

StrPath = str | os.PathLike[str]
PACKAGE = os.path.dirname(os.path.dirname(__file__)) + os.sep
"""Folder of the package, whose lines are not those of a caller."""


class Diagnostic(Exception):  # noqa: N818
    """Fields that errors and warnings share.

    Parameters
    ----------
    problem : str
        The constraint and the value received, without a full stop.
    code : str
        Stable identifier in kebab case, for programs and tests. Wording may change
        between versions, codes do not.
    path : path-like, optional
        The file concerned.
    line : int, optional
        Line in ``path``, counted from 1.
    entry : str, optional
        Name of the atlas entry concerned.
    hint : str, optional
        How to solve the problem. It names parameters of the library, never options of
        the command line.
    """

    code = "error"
    """Used where a call site gives no code."""

    def __init__(
        self,
        problem: str,
        *,
        code: str | None = None,
        path: StrPath | None = None,
        line: int | None = None,
        entry: str | None = None,
        hint: str = "",
    ) -> None:
        self.problem = problem
        self.path = path
        self.line = line
        self.entry = entry
        self.hint = hint
        if code is not None:
            self.code = code
        super().__init__(self.describe(hint))

    @property
    def where(self) -> str:
        """Location as ``path:line: entry 'name'``, as far as it is known; empty if
        nothing is.
        """
        place = ":".join(
            str(part) for part in (self.path, self.line) if part is not None
        )
        entry = "" if self.entry is None else f"entry '{self.entry}'"
        return ": ".join(part for part in (place, entry) if part)

    def __str__(self) -> str:
        """One line: location, problem, hint, as `describe` of the library's
        own hint.
        """
        return self.describe(self.hint)

    def describe(self, hint: str) -> str:
        """Location, problem and another hint in one line, with control characters
        escaped.
        """
        text = f"{self.where}: {self.problem}" if self.where else self.problem
        return printable(f"{text}; {hint}" if hint else text)

    def to_json(self) -> dict[str, Any]:
        """``code``, ``where``, ``problem`` and ``hint``, all text, for machines."""
        return {
            "code": self.code,
            "where": self.where,
            "problem": self.problem,
            "hint": self.hint,
        }


class UpliftError(Diagnostic):
    """Base class of all errors that uplift raises on purpose."""


class AtlasError(UpliftError, ValueError):
    """An atlas cannot be read or used."""

    code = "atlas"


class UnknownNameError(UpliftError, KeyError):
    """A name is unknown, such as that of an illuminant, an RGB space, a mode or an
    atlas entry.
    """

    code = "unknown-name"


class OptionError(UpliftError, ValueError):
    """An option is outside its range, of the wrong type, or does not go with others."""

    code = "option"


class CubeFileError(UpliftError, ValueError):
    """A cube file is missing, damaged, of another version, or not a cube."""

    code = "cube-file"


class ChartFileError(UpliftError, ValueError):
    """A chart table is missing, damaged, or not a chart table."""

    code = "chart-file"


class PlanFileError(UpliftError, ValueError):
    """A scene file or a plan is missing, invalid, out of date, or cannot be
    satisfied.
    """

    code = "plan-file"


class LookError(UpliftError, ValueError):
    """A look cannot be read, or contradicts the cube or another look."""

    code = "look"


class PaletteError(UpliftError, ValueError):
    """A palette specification cannot be read or has no solution."""

    code = "palette"


class PassesError(UpliftError, ValueError):
    """A file of passes, or one of their images, cannot be read or does not fit."""

    code = "passes"


class PaintError(UpliftError, ValueError):
    """A file of paints cannot be read, or samples do not determine paints."""

    code = "paint"


class ColourError(UpliftError, ValueError):
    """A colour is outside [0, 1], not finite, unreadable, or one that a cube or a
    reflectance cannot have.
    """

    code = "colour"


class TextureError(UpliftError, ValueError):
    """An image cannot be read or has no colour channels."""

    code = "texture"


class OutputError(UpliftError, OSError):
    """An output path cannot be written, or exists already."""

    code = "output"


class UpliftWarning(Diagnostic, UserWarning):
    """Something was skipped, changed or not reached; the work went on."""

    code = "warning"


def warn(warning: UpliftWarning) -> None:
    """Issue a warning at the line that called this package."""
    level = depth = 1
    frame = sys._getframe()
    while frame is not None:
        if frame.f_code.co_filename.startswith(PACKAGE):
            level = depth
        frame = frame.f_back  # type: ignore[assignment]
        depth += 1
    warnings.warn(warning, stacklevel=level + 1)


def unknown_name(
    name: str, known: Iterable[str], kind: str, lister: str = ""
) -> UnknownNameError:
    """Make the error for an unknown name of a ``kind``. Its hint has the nearest names,
    or the ``lister`` of all.

    >>> error = unknown_name("srbg", ("sRGB", "P3-D65"), "RGB space")
    >>> print(error.code, "|", error)
    unknown-name | unknown RGB space 'srbg'; did you mean 'sRGB'?
    """
    import difflib

    by_folded = {entry.casefold(): entry for entry in known if entry != name}
    near = difflib.get_close_matches(name.casefold(), by_folded, n=3)
    everything = (
        f"{lister} lists all"
        if lister
        else f"known: {listed(list(by_folded.values()))}"
    )
    choices = ", ".join(f"'{by_folded[entry]}'" for entry in near)
    return UnknownNameError(
        f"unknown {kind} '{name}'",
        hint=f"did you mean {choices}?" if near else everything,
    )


@contextlib.contextmanager
def needs_package(purpose: str, error: type[UpliftError]) -> Iterator[None]:
    """Import an optional package in the block; ``error`` names it if it is missing."""
    try:
        yield
    except ImportError as cause:
        name = (cause.name or "").partition(".")[0]
        raise error(
            f"{purpose} need the module '{name}', which is not installed",
            code="extra-not-installed",
            hint=f"install it: pip install {name.replace('_', '-')}",
        ) from cause
