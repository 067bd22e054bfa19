"""Everything that can go wrong on purpose: what is the matter, where, and what to do about it."""

from __future__ import annotations

import os


class UpliftError(Exception):
    """Bad input. ``str()`` is one line: the place, the problem, the hint.

    Parameters
    ----------
    problem : what is wrong, without a full stop.
    path, line, entry : where, as far as it is known (``line`` counts from 1).
    hint : what the user can do.
    """

    def __init__(
        self,
        problem: str,
        *,
        path: str | os.PathLike[str] | None = None,
        line: int | None = None,
        entry: str | None = None,
        hint: str = "",
    ) -> None:
        self.problem, self.path, self.line = problem, path, line
        self.entry, self.hint = entry, hint
        super().__init__(str(self))

    def __str__(self) -> str:
        place = "" if self.path is None else os.fspath(self.path)
        if self.line is not None:
            place += f":{self.line}"
        where = [place] if place else []
        if self.entry is not None:
            where.append(f"entry '{self.entry}'")
        text = ": ".join([*where, self.problem])
        return f"{text}; {self.hint}" if self.hint else text


class AtlasError(UpliftError):
    """An atlas that cannot be read or used."""


class UnknownNameError(UpliftError):
    """A name that the tables do not hold: illuminant, observer, RGB space, model, atlas entry."""


class OptionError(UpliftError):
    """An option outside its range."""


class CubeFileError(UpliftError):
    """A cube file that is missing, broken, of another version, or no cube at all."""


class ChartFileError(UpliftError):
    """A chart's table that is missing, broken, or no such table."""


class PlanFileError(UpliftError):
    """A scene file or a plan that is missing, broken, out of date, or asks for what cannot be."""


class PaletteError(UpliftError):
    """A palette's spec that cannot be read, or asks for what cannot be worked out."""


class ColourError(UpliftError):
    """A colour that cannot be asked for: outside [0, 1], NaN, or unreadable."""


class TextureError(UpliftError):
    """An image that cannot be read, or holds no colour."""


class OutputError(UpliftError):
    """An output path that cannot be written, or that exists already."""


class UpliftWarning(UserWarning):
    """Something was left out or changed, named; the rest was done."""
