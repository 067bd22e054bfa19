"""The formats that paints are exported in: one function each."""

from pathlib import Path

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import write_text
from uplift.common.text import pluralise
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.export.lut import cube_text
from uplift.extras.paint.paint_page import page
from uplift.extras.paint.paint_program import describe_errors, write_program
from uplift.extras.paint.paints import Paints, check_unit

LUT_SIZE = 33
HIDDEN = 1.0
"""ΔE00 between a layer on white and on black at which it hides the ground."""
THINNEST = 1e-4
"""Thickness, in that of the hiding layer, from which the search starts."""


def export_program(paints: Paints, path: Path, style: str, *, force: bool) -> str:
    """Write a program, and return a line about it."""
    samples = write_program(paints, path, style=style, force=force)
    wavelengths = pluralise(len(samples.paints.wavelengths), "wavelength")
    count = pluralise(len(paints), "paint")
    return f"{count} at {wavelengths}; {describe_errors(samples)}"


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
    thickest = max(hiding_thickness(paints, row) for row in np.eye(2))
    check_unit(paints, thickest)
    axis = np.linspace(0, 1, LUT_SIZE)
    table = np.stack([_colours(paints, share, axis, thickest) for share in axis])
    first, second = paints.names
    title = (
        f"red: share of {second} in {first}; green: root of the thickness, 1 is "
        f"{thickest:.3g}; blue: grey ground"
    )
    write_text(cube_text(table, title, LUT_SIZE), path, force=force)
    errors = _lut_errors(paints, table, thickest)
    return (
        f"{first} and {second}, up to a thickness of {thickest:.3g}; interpolated to "
        f"a mean ΔE00 of {errors.mean():.2f}, at most {errors.max():.1f}"
    )


def _colours(paints: Paints, share: float, axis: Array, thickest: float) -> Array:
    """Return codes (n, n, 3) in [0, 1] of a mixture, over roots of the thickness and
    codes of the ground.
    """
    grounds = decode(axis)[:, None] * np.ones(len(paints.wavelengths))
    films = []
    for depth in axis:
        thickness = thickest * depth**2
        coat = paints.pigments.coat([1 - share, share], thickness, paints.surface)
        films.append(coat.over(grounds))
    return encode(paints.sensor.rgb(np.stack(films)))


def _lut_errors(paints: Paints, table: Array, thickest: float) -> Array:
    """Return ΔE00 of a table at the middles of its cells."""
    from scipy.interpolate import interpn

    axis = np.linspace(0, 1, LUT_SIZE)
    middles = (axis[:-1] + axis[1:]) / 2
    exact = np.stack([_colours(paints, share, middles, thickest) for share in middles])
    places = np.stack(np.meshgrid(middles, middles, middles, indexing="ij"), axis=-1)
    near = interpn((axis,) * 3, table, places)
    return delta_e_rgb(paints.sensor, decode(exact), decode(near))


def hiding_thickness(paints: Paints, parts: Array) -> float:
    """Return the thickness at which a mixture on white and on black differs by ΔE00
    `HIDDEN`.
    """
    sensor = paints.sensor

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
    write_text(page(paints), path, force=force)
    return f"page of {pluralise(len(paints), 'paint')}"
