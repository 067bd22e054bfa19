"""A look: a colour, and what it is to be under other lights; looks as a TOML file."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from uplift.common.arrays import StrPath
from uplift.common.errors import LookError, UpliftError
from uplift.common.text import format_value, shorten
from uplift.extras.colour.srgb import is_number, parse_colour

MAX_TARGET = 2.0
"""Limit of the linear sRGB of a target: brighter colours are typing errors."""
EXAMPLE = "write [[look]] tables such as rgb = '#8a2a20' and FL11 = '#70392a'"

WrittenRgb = str | Sequence[float]


@dataclass(frozen=True)
class Look:
    """A colour, and what it is to be under other lights.

    Parameters
    ----------
    rgb : str or sequence of float
        The colour under the build illuminant, as ``"#rrggbb"`` in the encoding of the
        cube's RGB space, or as three linear numbers in [0, 1].
    lights : mapping of str to str or sequence of float
        Target colours by the names of illuminants, as ``"#rrggbb"`` in sRGB, or as
        linear sRGB. The white of the light is the white of sRGB (Bradford), as in relit
        images.
    weight : float, default 1
        Weight of the targets, above 0 and at most 1; the rest is the colour that is
        expected without the look.
    name : str, optional
        Name of the look, by default made of its colour.
    path : path-like, optional
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

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise LookError(
                f"the name of a look must be text, got {format_value(self.name)}",
                path=self.path,
            )
        object.__setattr__(self, "name", self.name or f"look {format_rgb(self.rgb)}")
        if not self.lights:
            raise look_error(
                self, "must name at least one light", hint="add FL11 = '#70392a'"
            )
        if not is_number(self.weight) or not 0 < self.weight <= 1:
            problem = (
                f"weight must be above 0 and at most 1, got {format_value(self.weight)}"
            )
            raise look_error(self, problem, hint="leave it out for 1")
        targets = [
            (light, target, -MAX_TARGET, MAX_TARGET)
            for light, target in self.lights.items()
        ]
        for key, value, low, high in [("rgb", self.rgb, 0, 1), *targets]:
            try:
                linear = parse_colour(value).linear
            except UpliftError as error:
                raise look_error(
                    self, f"{key} {error.problem}", error.code, error.hint
                ) from error
            if any(not low <= number <= high for number in linear):
                problem = (
                    f"{key} must be linear RGB in [{low:g}, {high:g}], got "
                    f"{format_value(list(linear))}"
                )
                raise look_error(
                    self, problem, hint="write '#rrggbb' for encoded values"
                )


LooksLike = StrPath | Look | Sequence[Look]


def about(look: Look, problem: str) -> str:
    """Put the name of a look in front of a problem; that of a look without a name
    begins with "look" itself.
    """
    label = (
        look.name if look.name.startswith("look ") else f"look '{shorten(look.name)}'"
    )
    return f"{label}: {problem}"


def look_error(
    look: Look, problem: str, code: str | None = None, hint: str = ""
) -> LookError:
    """Make an error with the name and location of a look."""
    return LookError(about(look, problem), code=code, path=look.path, hint=hint)


def format_rgb(rgb: WrittenRgb) -> str:
    """Return a colour as written on one line: ``#8a2a20`` or ``0.25 0.02 0.01``."""
    if isinstance(rgb, str):
        return rgb
    return " ".join(map("{:.4g}".format, np.ravel(rgb).tolist()))


def as_looks(looks: LooksLike) -> tuple[Look, ...]:
    """Return looks as given, or read from a file."""
    if isinstance(looks, str | os.PathLike):
        return read_looks(looks)
    given = (looks,) if isinstance(looks, Look) else tuple(looks)
    for item in given:
        if not isinstance(item, Look):
            raise LookError(f"looks must be Look objects, got {format_value(item)}")
    return given


def read_looks(path: StrPath) -> tuple[Look, ...]:
    """Read a file of looks.

    Parameters
    ----------
    path : path-like
        A TOML file.

    Returns
    -------
    tuple of Look
        The looks, in the order of the file.

    Raises
    ------
    LookError
        A file that cannot be read, or a value that does not fit.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "looks.toml")
    ...     table = '[[look]]\\nrgb = "#8a2a20"\\nFL11 = "#70392a"\\nname = "brick"'
    ...     _ = path.write_text(table)
    ...     [look] = read_looks(path)
    >>> look.name, look.lights
    ('brick', {'FL11': '#70392a'})
    """
    from uplift.extras.files.spec import read_spec  # imports pydantic
    from uplift.extras.looks.looks_file import LooksFile

    tables = read_spec(path, LooksFile, LookError, hint=EXAMPLE).look
    return tuple(
        Look(table.rgb, table.model_extra or {}, table.weight, table.name, path)
        for table in tables
    )
