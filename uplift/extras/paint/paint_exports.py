"""The formats that paints are exported in: one function each."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.colorimetry import delta_e_rgb, observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import write_text
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.export.lut import cube_text
from uplift.extras.paint.paint_page import write_page
from uplift.extras.paint.paint_program import describe_errors, write_program
from uplift.extras.paint.paints import Paints

LUT_SIZE = 33
HIDDEN = 1.0
"""ΔE00 between a layer on white and on black at which it hides the ground."""
THINNEST = 1e-4
"""Thickness, in that of the hiding layer, from which the search starts."""


def export_program(paints: Paints, path: Path, style: str, *, force: bool) -> str:
    """Write a program, and return a line about it."""
    samples = write_program(paints, path, style=style, force=force)
    count = len(samples.paints.wavelengths)
    return f"{len(paints)} paints at {count} wavelengths; {describe_errors(samples)}"


def export_lut(paints: Paints, path: Path, style: str, *, force: bool) -> str:
    """Write the colours of two paints as a 3-D table: red is the share of the second,
    green the root of the thickness, in the one that hides the ground, and blue a grey
    ground, encoded as sRGB.
    """
    if len(paints) != 2:
        raise OptionError(
            f"a table has two paints, got {len(paints)}",
            code="two-paints",
            hint="select two of the paints",
        )
    sensor = observer.sensor(wavelengths=(400, 700, 10))
    sampled = paints.at(sensor.wavelengths)
    thickest = max(hiding_thickness(sampled, row) for row in np.eye(2))
    axis = np.linspace(0, 1, LUT_SIZE)
    table = np.empty((LUT_SIZE,) * 3 + (3,))
    for row, share in enumerate(axis):
        for column, depth in enumerate(axis):
            for layer, code in enumerate(axis):
                ground = float(decode(np.array(code)))
                thickness = thickest * depth**2
                mixed = sampled.reflectance([1 - share, share], thickness, ground)
                table[row, column, layer] = encode(sensor.rgb(mixed))
    first, second = paints.names
    title = (
        f"red: share of {second} in {first}; green: root of the thickness, 1 is "
        f"{thickest:.3g}; blue: grey ground"
    )
    write_text(cube_text(table, title, LUT_SIZE), path, force=force)
    return f"{first} and {second}, up to a thickness of {thickest:.3g}"


def hiding_thickness(paints: Paints, parts: Array) -> float:
    """Return the thickness at which a mixture on white and on black differs by ΔE00
    `HIDDEN`.
    """
    nm = paints.wavelengths
    sensor = observer.sensor(wavelengths=(nm[0], nm[-1], nm[1] - nm[0]))

    def difference(thickness: float) -> float:
        grounds = [
            np.clip(sensor.rgb(paints.reflectance(parts, thickness, ground)), 0, 1)
            for ground in (0.0, 1.0)
        ]
        return float(delta_e_rgb(sensor, *grounds))

    thickness = THINNEST
    while difference(thickness) > HIDDEN and thickness < 1 / THINNEST:
        thickness *= 1.05
    return thickness


def export_page(paints: Paints, path: Path, style: str, *, force: bool) -> str:
    """Write a page with the paints as tubes, which mixes them and finds recipes."""
    write_page(paints, path, force=force)
    return f"page of {len(paints)} paints"


@dataclass(frozen=True)
class PaintExport:
    """A format that paints are written in.

    Parameters
    ----------
    suffix : str
        Suffix of its files.
    about : str
        What it is, for the help.
    write : callable
        Takes the paints, a path, the name of the format and ``force``, and returns a
        line about what it wrote.
    """

    suffix: str
    about: str
    write: Callable[..., str]


PROGRAM = ("program that mixes the paints at a few wavelengths", export_program)
PAINT_EXPORTS = {
    "c": PaintExport(".h", *PROGRAM),
    "glsl": PaintExport(".glsl", *PROGRAM),
    "hlsl": PaintExport(".hlsl", *PROGRAM),
    "cube": PaintExport(".cube", "table of two paints on grey grounds", export_lut),
    "html": PaintExport(".html", "page that mixes the paints", export_page),
}
"""The formats by name."""
