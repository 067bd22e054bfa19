"""Colours of ``uplift query``: from arguments, options, a file or standard input."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.common.arrays import Array


def find_point(
    colour: tuple[str, ...],
    input_path: str | None,
    xyz: tuple[float, float, float] | None,
    xy: tuple[float, float] | None,
    luminance: float | None,
) -> tuple[tuple[float, float, float] | None, bool]:
    """Return XYZ of --xyz, or of --xy and --luminance, None without them; and whether there is a single colour.

    Raises `ColourError`, and click's error if there is not exactly one source of colours.
    """
    if (xy is None) != (luminance is None) or (xyz is not None and xy is not None):
        raise click.UsageError("--xy X Y and --luminance Y require each other, and --xyz is an alternative.")
    if xy is not None and luminance is not None:
        from uplift.common.errors import ColourError

        x, y = xy
        if not y > 0:
            problem = f"y of a chromaticity must be positive, got {y:g}"
            raise ColourError(problem, code="invalid-chromaticity", hint="give CIE x and y")
        xyz = x * luminance / y, luminance, (1 - x - y) * luminance / y
    if xyz is not None and (colour or input_path is not None):
        raise click.UsageError("Give one colour, --input FILE, '-', --xyz or --xy. See 'uplift query --help'.")
    return xyz, xyz is not None or (bool(colour) and colour != ("-",))


def read_colours(
    words: tuple[str, ...],
    path: str | None,
    sensor: Sensor,
    *,
    encoded: bool,
    bounded: bool,
    space: ImageSpace | None,
) -> Iterable[Array]:
    """Return blocks of linear RGB (n, 3) from arguments, a file or standard input."""
    from .colours import from_arguments

    if words == ("-",):
        words, path = (), path or "-"
    if bool(words) == (path is not None):
        raise click.UsageError("Give one colour, or --input FILE, or '-'. See 'uplift query --help'.")
    if path is None:
        return [from_arguments(words, sensor, encoded=encoded, space=space)]
    return _read_file(path, sensor, encoded=encoded, bounded=bounded, space=space)


def _read_file(path: str, sensor: Sensor, *, encoded: bool, bounded: bool, space: ImageSpace | None) -> Iterator[Array]:
    from uplift.common.errors import ColourError

    from .colours import from_table

    name = "standard input" if path == "-" else path
    try:
        with click.open_file(path, "rb") as file:
            yield from from_table(file, name, sensor, encoded=encoded, bounded=bounded, space=space)
    except OSError as error:
        raise ColourError(
            f"cannot be read: {error.strerror}",
            code="file-unreadable",
            path=path,
            hint="give a CSV file of colours",
        ) from error
