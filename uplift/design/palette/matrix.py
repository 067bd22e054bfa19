"""The palette matrix: for every material under every light the colour wanted, obtained, and by the factor model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.design.palette.colours import screen_matrix
from uplift.design.palette.design import Design
from uplift.design.palette.palette import ColourGoal, MinDifference


@dataclass(frozen=True, eq=False)
class Matrix:
    """Linear RGB as on a screen, M materials by L lights.

    Parameters
    ----------
    wanted : (M, L, 3), NaN where nothing is.
    obtained, factor : (M, L, 3) by full spectra, by the factor model.
    missed : (M, L) ΔE00 from wanted to obtained, NaN where nothing is wanted.
    model_error : (M, L) ΔE00 from full spectra to the factor model.
    whites : (L, 3) the perfect reflector under each light.
    """

    target: Array
    obtained: Array
    factor: Array
    delta_e: Array
    model_error: Array
    whites: Array


def matrix(design: Design) -> Matrix:
    """All colours of a design. ΔE00 are those of colours on a screen, against its white."""
    palette, model = design.palette, design.model
    screen = screen_matrix(palette.sensor)
    obtained = (design.reflectances[:, None] * design.powers) @ screen.T
    factor = model.rgb(
        model.product(model.reflectance(design.reflectances)[:, None], model.light(design.powers))
    )
    wanted = np.full_like(obtained, np.nan)
    for wish in palette.goals:
        wanted[place(design, wish)] = wanted_colour(design, wish)
    return Matrix(
        wanted,
        obtained,
        factor,
        delta_e_rgb(palette.sensor, wanted, obtained),
        delta_e_rgb(palette.sensor, obtained, factor),
        design.powers @ screen.T,
    )


def wanted_colour(design: Design, wish: ColourGoal) -> Array:
    """(3,) linear RGB that a wish came to mean."""
    if wish.rgb is not None:
        return wish.rgb
    assert wish.free is not None
    return design.free[wish.free]


def place(design: Design, wish: ColourGoal) -> tuple[int, int]:
    """Row and column of a wish."""
    rows = [part.name for part in design.palette.materials]
    columns = [part.name for part in design.palette.lights]
    return rows.index(wish.material), columns.index(wish.light)


def difference(design: Design, colours: Matrix, apart: MinDifference) -> float:
    """ΔE00 between two materials under a light."""
    first, second = (
        colours.obtained[place(design, ColourGoal(material, apart.light))] for material in apart.materials
    )
    return float(delta_e_rgb(design.palette.sensor, first, second))
