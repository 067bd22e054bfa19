"""Design of the open spectra of a palette by one linear least-squares problem.

References
----------
S. Bergner, T. Möller, M. S. Drew, *A Spectral Engine for Visualization*, 2004, section 3.3.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import PaletteError
from uplift.design.palette.equations import equations, underdetermined_goal, unknowns
from uplift.design.palette.factor import FactorModel
from uplift.design.palette.palette import Palette
from uplift.fit.bounded_least_squares import solve_bounded


@dataclass(frozen=True, eq=False)
class Design:
    """A palette with all spectra.

    Parameters
    ----------
    palette : Palette
        The palette.
    model : FactorModel
        The factor model whose error the design keeps small.
    powers : ndarray, shape (L, N)
        Powers of the lights in the palette's order.
    reflectances : ndarray, shape (M, N)
        Reflectances of the materials.
    free : mapping
        Linear RGB (3,) of each free colour.
    """

    palette: Palette
    model: FactorModel
    powers: Array
    reflectances: Array
    free: Mapping[str, Array]


def design(palette: Palette, model: FactorModel) -> Design:
    """Compute the open spectra and the free colours of a palette.

    Parameters
    ----------
    palette : Palette
        The palette.
    model : FactorModel
        Factor model on the palette's wavelengths.

    Returns
    -------
    Design
        The spectra of least squared error within their bounds.

    Raises
    ------
    PaletteError
        If both light and material of a goal are open.

    Warns
    -----
    UpliftWarning
        If the solver stops before it converges.
    """
    goal = underdetermined_goal(palette)
    if goal is not None:
        raise PaletteError(
            f"light or material of a goal must be given, got {goal}, both to be designed",
            code="goal-underdetermined",
            hint="give one of them, or remove the goal",
        )
    where, x = unknowns(palette), solve_bounded(equations(palette, model))
    return Design(
        palette,
        model,
        np.array([x[where.light(s.name)] if s.samples is None else s.samples for s in palette.lights]),
        np.array([x[where.material(s.name)] if s.samples is None else s.samples for s in palette.materials]),
        {name: x[where.free(name)] for name in palette.free},
    )
