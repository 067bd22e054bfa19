"""Designing: the spectra that make the colours of a palette, by one linear least-squares problem (Bergner, 3.3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import PaletteError
from uplift.design.palette.equations import equations, undetermined, unknowns
from uplift.design.palette.factor import FactorModel
from uplift.design.palette.palette import Palette
from uplift.design.palette.solve import solve


@dataclass(frozen=True, eq=False)
class Design:
    """A palette with all its spectra.

    Parameters
    ----------
    palette, model : what was asked, and the factor model that it was designed for.
    powers : (L, N) of the lights, given and designed, in the palette's order.
    reflectances : (M, N) of the materials.
    free : linear RGB (3,) that each free colour took.
    """

    palette: Palette
    model: FactorModel
    powers: Array
    reflectances: Array
    free: Mapping[str, Array]


def design(palette: Palette, model: FactorModel) -> Design:
    """Find what is open in a palette.

    Raises
    ------
    PaletteError : a colour of which neither light nor material is given.
    """
    wish = undetermined(palette)
    if wish is not None:
        raise PaletteError(
            f"a colour for {wish}, both of which are to be designed",
            hint="give one of them, or leave the colour out",
        )
    where, found = unknowns(palette), solve(equations(palette, model))
    return Design(
        palette,
        model,
        np.array([found[where.light(p.name)] if p.samples is None else p.samples for p in palette.lights]),
        np.array(
            [found[where.material(p.name)] if p.samples is None else p.samples for p in palette.materials]
        ),
        {name: found[where.free(name)] for name in palette.free},
    )
