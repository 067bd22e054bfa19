"""A look: a colour, and what it is to be under other lights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from uplift.colorimetry.written_colour import WrittenColour, is_number, parse_colour
from uplift.common.arrays import StrPath
from uplift.common.errors import LookError, UpliftError
from uplift.common.text import format_value, shorten

MAX_WISH = 2.0
"""Limit of the linear sRGB of a wish: brighter colours are typing errors."""

WrittenRgb = str | Sequence[float]


@dataclass(frozen=True)
class Look:
    """A colour, and what it is to be under other lights.

    Parameters
    ----------
    rgb : str or sequence of float
        The colour under the build illuminant, as ``"#rrggbb"`` in the encoding of the cube's RGB space, or as three
        linear numbers in [0, 1].
    lights : mapping of str to str or sequence of float
        Wished colours by the names of illuminants, as ``"#rrggbb"`` in sRGB, or as linear sRGB. The white of the light
        is the white of sRGB (Bradford), as in relit images.
    weight : float, default 1
        Share of the wish, above 0 and at most 1; the rest is the colour that is expected without the look.
    name : str, optional
        Name of the look, by default made of its colour.
    path, line : optional
        Where the look is written, for errors.

    Raises
    ------
    LookError
        A value that does not fit.

    Examples
    --------
    >>> Look("#8a2a20", {"FL11": "#70392a"}).name
    'look #8a2a20'
    """

    rgb: WrittenRgb
    lights: Mapping[str, WrittenRgb]
    weight: float = 1.0
    name: str = ""
    path: StrPath | None = field(default=None, compare=False)
    line: int | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or f"look {format_rgb(self.rgb)}")
        if not self.lights:
            raise self.error("must name at least one light", code="look-without-lights", hint="add FL11 = '#70392a'")
        if not is_number(self.weight) or not 0 < self.weight <= 1:
            problem = f"weight must be above 0 and at most 1, got {format_value(self.weight)}"
            raise self.error(problem, code="look-weight-out-of-range", hint="leave it out for 1")
        self.colour("rgb", self.rgb, 0, 1)
        for light, wish in self.lights.items():
            self.colour(light, wish, -MAX_WISH, MAX_WISH)

    def colour(self, key: str, value: WrittenRgb, low: float, high: float) -> WrittenColour:
        """Parse a colour of the look and check its range.

        Parameters
        ----------
        key : str
            Name of the colour in errors.
        value : str or sequence of float
            The colour as written.
        low, high : float
            Range of linear numbers.

        Returns
        -------
        WrittenColour

        Raises
        ------
        LookError
            A value that is not a colour, or outside the range.
        """
        try:
            colour = parse_colour(value)
        except UpliftError as error:
            raise self.error(f"{key} {error.problem}", code=error.code, hint=error.hint) from error
        if any(not low <= number <= high for number in colour.linear):
            problem = f"{key} must be linear RGB in [{low:g}, {high:g}], got {format_value(list(colour.linear))}"
            raise self.error(problem, code="look-out-of-range", hint="write '#rrggbb' for encoded values")
        return colour

    def about(self, problem: str) -> str:
        """Put the name of the look in front of a problem.

        Parameters
        ----------
        problem : str
            The problem.

        Returns
        -------
        str
            Such as ``look 'brick': is missed``; the name of a look without a name begins with "look" itself.
        """
        label = self.name if self.name.startswith("look ") else f"look '{shorten(self.name)}'"
        return f"{label}: {problem}"

    def error(self, problem: str, *, code: str, hint: str = "") -> LookError:
        """Make an error about the look.

        Parameters
        ----------
        problem : str
            The constraint and the value received.
        code : str
            Code of the error.
        hint : str
            How to solve the problem.

        Returns
        -------
        LookError
            The error to raise, with the location of the look.
        """
        return LookError(self.about(problem), code=code, path=self.path, line=self.line, hint=hint)


def format_rgb(rgb: WrittenRgb) -> str:
    """Return a colour as written on one line.

    Parameters
    ----------
    rgb : str or sequence of float
        The colour.

    Returns
    -------
    str
        Such as ``#8a2a20`` or ``0.25 0.02 0.01``.
    """
    return rgb if isinstance(rgb, str) else " ".join(f"{value:.4g}" for value in np.ravel(rgb).tolist())
