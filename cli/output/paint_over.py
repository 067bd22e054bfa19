"""Images painted over with a coat."""

from __future__ import annotations

import warnings
from dataclasses import asdict
from typing import TYPE_CHECKING

from ..params.ingredients import library_ingredients
from ..startup import enable_jit_cache
from .console import say
from .progress import progress_bar

if TYPE_CHECKING:
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.design.mixing import Medium
    from uplift.design.mixing.overpaint import Overpainter
    from uplift.lookup import Cube

    from ..params.ingredients import Ingredient


def make_brush(
    cube: Cube,
    kind: str,
    ingredients: list[Ingredient],
    medium: Medium,
    scattering: str,
    encoding: str,
    method: str,
    space: ImageSpace | None,
) -> Overpainter:
    """Mix a coat and prepare it at the wavelengths of the cube's sensor; ``scattering`` is recorded by its name."""
    enable_jit_cache()
    from uplift.design.mixing import make_coat, overpainter

    count = len(cube.data.sensor.wavelengths)
    parts = [one.parts for one in ingredients]
    mixture = make_coat(kind, library_ingredients(ingredients, count), parts, medium)
    recipe = {
        "kind": kind,
        "of": [[one.parts, one.name] for one in ingredients],
        "thickness": medium.thickness,
        "surface": asdict(medium.surface),
        "scattering": scattering,
    }
    return overpainter(cube, mixture, recipe, encoding=encoding, out_of_gamut=method, space=space)


def paint(brush: Overpainter, image: str, output: str, *, force: bool) -> None:
    """Paint over an image, write the result, and print warnings and the number of pixels."""
    from uplift.io.texture import convert

    with progress_bar("rows") as progress:
        painted = convert(brush, image, output, force=force, progress=progress)
    for warning in painted.warnings:
        warnings.warn(warning, stacklevel=1)
    say(f"{output}: {painted.counts.pixels:,} pixels painted over")
