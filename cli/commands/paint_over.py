"""Paintings under a coat, from the command line."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import click

from uplift.common.errors import UpliftWarning

from ..output.progress import progress_bar
from ..params.ingredients import given
from ..startup import keep_compiled

if TYPE_CHECKING:
    from uplift.design.mixing.overpaint import Brush
    from uplift.design.mixing.recipes import Medium
    from uplift.lookup import Cube

    from ..params.ingredients import Ingredient


def brush(
    cube: Cube, kind: str, ingredients: list[Ingredient], medium: Medium, encoding: str, way: str
) -> Brush:
    """Made ready to paint with, at the wavelengths of the cube's sensor."""
    keep_compiled()
    from dataclasses import asdict

    from uplift.design.mixing.overpaint import ready
    from uplift.design.mixing.recipes import coat

    count = len(cube.data.sensor.wavelengths)
    made = coat(kind, given(ingredients, count), [one.parts for one in ingredients], medium)
    recipe = {"kind": kind, "of": [[one.parts, one.name] for one in ingredients], **asdict(medium)}
    return ready(cube, made, recipe, encoding=encoding, out_of_gamut=way)


def paint(brush: Brush, over: str, output: str, *, force: bool) -> None:
    """Paint, and say what should be said."""
    from uplift.design.mixing.overpaint import paint_over

    with progress_bar("rows") as progress:
        painted = paint_over(brush, over, output, force=force, progress=progress)
    for remark in painted.remarks:
        warnings.warn(f"{over}: {remark}", UpliftWarning, stacklevel=1)
    click.echo(f"{output}: {painted.counts.pixels:,} pixels painted over")
