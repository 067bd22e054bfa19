"""Colours of ``uplift query``: from arguments, options, a file or standard input."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.common.arrays import Array
    from uplift.lights.lookup import EmissionTable


def as_xyz(
    xyz: tuple[float, float, float] | None, xy: tuple[float, float] | None, luminance: float | None
) -> tuple[float, float, float] | None:
    """Return XYZ of --xyz, or of --xy and --luminance; None without them. Raises `ColourError` and click's error."""
    if (xy is None) != (luminance is None) or (xyz is not None and xy is not None):
        raise click.UsageError("--xy X Y and --luminance Y require each other, and --xyz is an alternative.")
    if xy is None or luminance is None:
        return xyz
    from uplift.common.errors import ColourError

    x, y = xy
    if not y > 0:
        problem = f"y of a chromaticity must be positive, got {y:g}"
        raise ColourError(problem, code="invalid-chromaticity", hint="give CIE x and y")
    return x * luminance / y, luminance, (1 - x - y) * luminance / y


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


def lights_xyz(
    table: EmissionTable,
    point: tuple[float, float, float] | None,
    words: tuple[str, ...],
    path: str | None,
    *,
    encoded: bool,
    space: ImageSpace | None,
) -> Iterable[Array]:
    """Return blocks of XYZ (n, 3) of lights from arguments, a file or standard input."""
    if point is not None:
        import numpy as np

        return [np.array([point])]
    from uplift.colorimetry.observer import sensor

    target = sensor(table.space)
    return map(table.xyz, read_colours(words, path, target, encoded=encoded, bounded=False, space=space))
