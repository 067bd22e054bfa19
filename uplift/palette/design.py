"""Designing: the spectra that make the colours of a palette, by one linear least-squares problem (Bergner, 3.3)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from uplift.errors import PaletteError, UpliftWarning
from uplift.sensor import Array

from .equations import Equations, equations, undetermined, unknowns
from .factor import FactorModel
from .palette import Palette

ENOUGH, MOST_STEPS = 1e-12, 1000
"""Relative change at which the bounded solver stops, and steps after which it gives up."""


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

    Without bounds by the pseudo-inverse: the global minimum, and of several the shortest. With bounds by active sets
    (BVLS of Stark & Parker 1995 in scipy's ``lsq_linear``): the minimum is global too, as the problem is convex, and
    the bounds are kept to the bit.

    Raises
    ------
    PaletteError : a colour of which neither light nor material is given.
    """
    wish = undetermined(palette)
    if wish is not None:
        raise PaletteError(
            f"a colour for {wish}, both of which are to be designed",
            remedy="give one of them, or leave the colour out",
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


def solve(problem: Equations) -> Array:
    """x (n,) of least ‖M x − y‖ within the bounds."""
    from scipy.optimize import lsq_linear
    from threadpoolctl import threadpool_limits

    if np.isinf(problem.low).all() and np.isinf(problem.high).all():
        return np.asarray(np.linalg.lstsq(problem.matrix, problem.values, rcond=None)[0])
    with threadpool_limits(1, user_api="blas"):  # the matrix is small: threads would wait for one another
        found = lsq_linear(
            problem.matrix,
            problem.values,
            (problem.low, problem.high),
            method="bvls",
            tol=ENOUGH,
            max_iter=MOST_STEPS,
        )
    if not found.success:
        warnings.warn(
            f"stopped after {MOST_STEPS} steps: colours may be a little off", UpliftWarning, stacklevel=2
        )
    return np.asarray(found.x)
