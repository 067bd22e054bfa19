"""Matrix of a design: target, obtained and modelled colour of every material under every light."""

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
    """Linear RGB on a display, for M materials and L lights.

    Parameters
    ----------
    target : ndarray, shape (M, L, 3)
        Targets of the goals; NaN without a goal.
    obtained, factor : ndarray, shape (M, L, 3)
        Colours by full spectra, and by the factor model.
    delta_e : ndarray, shape (M, L)
        ΔE00 from target to the colour that the palette fits, by spectra or by the factor model; NaN without a goal.
    model_error : ndarray, shape (M, L)
        ΔE00 from full spectra to the factor model.
    whites : ndarray, shape (L, 3)
        The perfect reflector under each light.
    """

    target: Array
    obtained: Array
    factor: Array
    delta_e: Array
    model_error: Array
    whites: Array


def matrix(design: Design) -> Matrix:
    """Compute all colours of a design.

    Parameters
    ----------
    design : Design
        The design.

    Returns
    -------
    Matrix
        Colours and their ΔE00 against the white of the display.
    """
    palette, model = design.palette, design.model
    screen = screen_matrix(palette.sensor)
    obtained = (design.reflectances[:, None] * design.powers) @ screen.T
    surfaces, lights = model.reflectance(design.reflectances), model.light(design.powers)
    factor = model.rgb(model.product(surfaces[:, None], lights))
    target = np.full_like(obtained, np.nan)
    for goal in palette.goals:
        target[cell_index(design, goal)] = target_colour(design, goal)
    return Matrix(
        target,
        obtained,
        factor,
        delta_e_rgb(palette.sensor, target, factor if palette.fit == "factor-model" else obtained),
        delta_e_rgb(palette.sensor, obtained, factor),
        design.powers @ screen.T,
    )


def target_colour(design: Design, goal: ColourGoal) -> Array:
    """Linear RGB (3,) of a goal; for a free colour the value that the design chose."""
    if goal.rgb is not None:
        return goal.rgb
    assert goal.free is not None
    return design.free[goal.free]


def cell_index(design: Design, goal: ColourGoal) -> tuple[int, int]:
    """Row and column of a goal."""
    rows = [material.name for material in design.palette.materials]
    columns = [light.name for light in design.palette.lights]
    return rows.index(goal.material), columns.index(goal.light)


def difference(design: Design, colours: Matrix, pair: MinDifference) -> float:
    """ΔE00 between two materials under a light."""
    fitted = colours.factor if design.palette.fit == "factor-model" else colours.obtained
    first, second = (fitted[cell_index(design, ColourGoal(material, pair.light))] for material in pair.materials)
    return float(delta_e_rgb(design.palette.sensor, first, second))
