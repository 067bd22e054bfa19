"""Paintings under a coat, from the command line."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import click

from uplift.errors import UpliftWarning

from .ingredients import given
from .progress import counting
from .startup import keep_compiled

if TYPE_CHECKING:
    from uplift.lookup import Cube
    from uplift.mixing.painting import Brush
    from uplift.mixing.recipes import Medium

    from .ingredients import Ingredient


def brush(
    cube: Cube, kind: str, ingredients: list[Ingredient], medium: Medium, encoding: str, way: str
) -> Brush:
    """Made ready to paint with, at the wavelengths of the cube's sensor."""
    keep_compiled()
    from dataclasses import asdict

    from uplift.mixing.painting import ready
    from uplift.mixing.recipes import coat

    count = len(cube.data.sensor.wavelengths)
    made = coat(kind, given(ingredients, count), [one.parts for one in ingredients], medium)
    recipe = {"kind": kind, "of": [[one.parts, one.name] for one in ingredients], **asdict(medium)}
    return ready(cube, made, recipe, encoding=encoding, out_of_gamut=way)


def paint(brush: Brush, over: str, output: str, *, force: bool) -> None:
    """Paint, and say what should be said."""
    from uplift.mixing.painting import paint_over

    with counting("rows") as watch:
        painted = paint_over(brush, over, output, force=force, watch=watch)
    for remark in painted.remarks:
        warnings.warn(f"{over}: {remark}", UpliftWarning, stacklevel=1)
    click.echo(f"{output}: {painted.counts.pixels:,} pixels painted over")
