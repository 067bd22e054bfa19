"""Recipes: the parts of paints whose mixture comes nearest to a colour.

Every set of up to ``count`` paints is tried. The shares of a set start from a grid over
their simplex and follow damped Gauss–Newton steps, all sets at once; the three terms of
CIEDE2000 under each light are the residuals.
The best shares are then rounded to parts that one can weigh, and the neighbours in
parts are tried as well. Of up to two paints the grid is dense enough that no better
shares exist; of more, the best of several starts is not proven to be the best.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from math import comb

import numpy as np

from uplift.colorimetry.delta_e import (
    delta_e_2000,
    delta_e_2000_terms,
    delta_e_spectra,
    lab,
)
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices, blocks
from uplift.common.errors import OptionError
from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
from uplift.extras.paint.optics import TINY
from uplift.extras.paint.paints import Paints, check_unit
from uplift.models.least_squares import least_squares

MAX_COUNT = 5
"""Largest number of paints of a recipe."""
MAX_SETS = 40_000
"""Largest number of sets of paints that are tried."""
FINE = tuple(np.linspace(-7, 7, 57).tolist())
"""Logarithms of the ratio of two paints from which solutions of a pair start."""
LEVELS = (-6.0, -4.5, -3.0, -1.5, 0.0, 1.5, 3.0, 4.5, 6.0)
"""The same of three paints, each to the first."""
COARSE = (-3.0, 0.0, 3.0)
"""The same of more."""
STARTS = 3
"""Starts of a set that are followed."""
STEPS = 12
LARGEST = 9.0
"""Largest logarithm of a ratio."""
DIFFERENCE = 1e-5
"""Change of a logarithm by which derivatives are computed."""
PRECISION = 1e-6
"""Relative change at which a descent ends."""
BLOCK = 1 << 16
"""Mixtures that are computed at a time."""
KEPT = 200
"""Sets whose shares are rounded to parts."""
NEARLY = 0.1
"""ΔE00 by which a recipe of fewer parts may be worse."""


@dataclass(frozen=True, eq=False)
class PaintTarget:
    """The reflectance that a recipe should match, and the lights that count.

    Parameters
    ----------
    reflectance : ndarray, shape (N,)
        Reflectance at the wavelengths of the paints.
    lights : tuple of Light
        Lights under which the colours count, on these wavelengths.
    thickness : float, optional
        Thickness of the layer, by default opaque.
    ground : ndarray, shape (N,), optional
        Ground below it, by default white.
    """

    reflectance: Array
    lights: tuple[Light, ...]
    thickness: float | None = None
    ground: Array | float = 1.0

    def colours(self, reflectance: Array) -> Array:
        """Compute colours under the lights.

        Parameters
        ----------
        reflectance : ndarray, shape (..., N)
            Reflectances at the wavelengths of the lights.

        Returns
        -------
        ndarray, shape (..., L, 3)
            CIE L*a*b* under each light.
        """
        colours = [lab(reflectance @ light.xyz.T, light.white) for light in self.lights]
        return np.stack(colours, axis=-2)


@dataclass(frozen=True, eq=False)
class PaintRecipe:
    """A mixture that comes near a target.

    Parameters
    ----------
    paints : tuple of str
        Names, the largest part first.
    parts : tuple of int
        Whole parts.
    reflectance : ndarray, shape (N,)
        Reflectance of the mixture.
    delta_e : tuple of float
        ΔE00 to the target under each light.
    cost : float
        Price of one part of the mixture, NaN if it is not known.
    """

    paints: tuple[str, ...]
    parts: tuple[int, ...]
    reflectance: Array
    delta_e: tuple[float, ...]
    cost: float

    def __str__(self) -> str:
        pairs = zip(self.parts, self.paints, strict=True)
        return " + ".join(f"{parts} {name}" for parts, name in pairs)

    @property
    def error(self) -> float:
        """Mean ΔE00 over the lights."""
        return float(np.mean(self.delta_e))


def match(
    target: PaintTarget,
    paints: Paints,
    *,
    count: int = 3,
    steps: int = 100,
    alternatives: int = 5,
) -> tuple[PaintRecipe, ...]:
    """Find the mixtures of a few paints that come nearest to a target.

    Parameters
    ----------
    target : PaintTarget
        What to match.
    paints : Paints
        Paints to choose from.
    count : int
        Largest number of paints in a mixture, 1 to `MAX_COUNT`.
    steps : int
        Most parts of a recipe in all, 1 to 10,000.
    alternatives : int
        Number of recipes, each of another set of paints.

    Returns
    -------
    tuple of PaintRecipe
        The nearest first.

    Raises
    ------
    OptionError
        An argument is out of range, or there are too many sets of paints.

    Warns
    -----
    UpliftWarning
        The thickness has no unit (``thickness-without-unit``): the paints were fitted
        to opaque samples.
    """
    _check(paints, count, steps, alternatives)
    check_unit(paints, target.thickness)
    problem = _Problem(target, paints)
    solved = []
    for size in range(1, min(count, len(paints)) + 1):
        sets = np.array(list(combinations(range(len(paints)), size)))
        solved.append(_solve(problem, sets))
    parts, squares = (np.concatenate(arrays) for arrays in zip(*solved, strict=True))
    nearest = np.argsort(squares, kind="stable")[:KEPT]
    recipes = [_round(problem, row, steps) for row in parts[nearest]]
    recipes.sort(key=lambda recipe: recipe.error)
    distinct = dict[frozenset[str], PaintRecipe]()
    for recipe in recipes:
        distinct.setdefault(frozenset(recipe.paints), recipe)
    return tuple(distinct.values())[:alternatives]


def _check(paints: Paints, count: int, steps: int, alternatives: int) -> None:
    for name, value, most in (
        ("count", count, MAX_COUNT),
        ("steps", steps, 10_000),
        ("alternatives", alternatives, KEPT),
    ):
        if not 1 <= value <= most:
            raise OptionError(
                f"{name} must be in [1, {most}], got {value}", hint="choose another"
            )
    sets = comb(len(paints), min(count, len(paints)))
    if sets > MAX_SETS:
        raise OptionError(
            f"{len(paints)} paints have {sets} sets of {count}, more than {MAX_SETS}",
            code="too-many-recipes",
            hint="allow fewer paints in a mixture, or choose from fewer",
        )


@dataclass(frozen=True, eq=False)
class _Problem:
    """Mixtures by parts (m, P) of all paints, near the target."""

    target: PaintTarget
    paints: Paints

    @cached_property
    def goals(self) -> Array:
        """Colours (L, 3) of the target."""
        return self.target.colours(self.target.reflectance)

    def reflectance(self, parts: Array) -> Array:
        """Return the reflectances (m, N) of mixtures."""
        return self.paints.reflectance(parts, self.target.thickness, self.target.ground)

    def residuals(self, parts: Array) -> Array:
        """Return the differences (m, 3 L) of mixtures to the target: terms of ΔE00."""
        pieces = []
        for rows in blocks(len(parts), BLOCK):
            colours = self.target.colours(self.reflectance(parts[rows]))
            differences = delta_e_2000_terms(colours, self.goals)
            pieces.append(differences.reshape(len(colours), -1))
        return np.concatenate(pieces)

    def parts(self, sets: Indices, ratios: Array) -> Array:
        """Return the parts (m, P) of sets of paints (m, k) by the logarithms (m, k − 1)
        of the ratios of their shares to the first.
        """
        logarithms = np.concatenate([np.zeros((len(sets), 1)), ratios], axis=1)
        weights = np.exp(logarithms - logarithms.max(axis=1, keepdims=True))
        parts = np.zeros((len(sets), len(self.paints)))
        shares = weights / weights.sum(axis=1, keepdims=True)
        np.put_along_axis(parts, sets, shares, axis=1)
        return parts

    def descend(self, sets: Indices, start: Array) -> Array:
        """Return the ratios (m, k − 1) that come nearest, from those of a start."""
        steps = DIFFERENCE * np.eye(start.shape[1])

        def residuals(ratios: Array, rows: Indices) -> Array:
            return self.residuals(self.parts(sets[rows], ratios))

        def normal_equations(
            ratios: Array, values: Array, rows: Indices
        ) -> tuple[Array, Array]:
            moved = [residuals(ratios + step, rows) for step in steps]
            jacobian = (np.stack(moved, axis=2) - values[..., None]) / DIFFERENCE
            slope = (jacobian.mT @ values[..., None])[..., 0]
            # Of a layer without thickness nothing changes the colour.
            gram = jacobian.mT @ jacobian + TINY * np.eye(len(steps))
            return gram, slope

        return least_squares(
            residuals,
            normal_equations,
            start,
            max_steps=STEPS,
            precision=PRECISION,
            limit=LARGEST,
        )


def _solve(problem: _Problem, sets: Indices) -> tuple[Array, Array]:
    """Return the best parts (m, P) of sets of paints (m, k), and their errors (m,)."""
    size = sets.shape[1]
    levels = {2: FINE, 3: LEVELS}.get(size, COARSE)
    grid = np.array(list(product(levels, repeat=size - 1)), dtype=float)
    repeated = np.repeat(sets, len(grid), axis=0)
    tried = problem.parts(repeated, np.tile(grid, (len(sets), 1)))
    squares = (problem.residuals(tried) ** 2).sum(axis=1).reshape(len(sets), -1)
    best = np.argsort(squares, axis=1)[:, :STARTS]
    followed = np.repeat(sets, best.shape[1], axis=0)
    ratios = grid[best.ravel()]
    if size > 1:
        ratios = problem.descend(followed, ratios)
    parts = problem.parts(followed, ratios)
    squares = (problem.residuals(parts) ** 2).sum(axis=1).reshape(best.shape)
    rows = np.arange(len(sets))
    chosen = squares.argmin(axis=1)
    return parts.reshape(*best.shape, -1)[rows, chosen], squares[rows, chosen]


def _round(problem: _Problem, shares: Array, steps: int) -> PaintRecipe:
    """Return the recipe of the fewest parts that is nearly as good as any of up to
    ``steps`` parts.
    """
    totals = np.arange(1, steps + 1)[:, None]
    counts = np.unique(np.rint(totals * shares).astype(int), axis=0)
    counts = counts[(counts.sum(axis=1) <= steps) & counts.any(axis=1)]
    counts = np.unique(counts // np.gcd.reduce(counts, axis=1)[:, None], axis=0)
    colours = problem.target.colours(problem.reflectance(counts))
    errors = delta_e_2000(colours, problem.goals)
    mean = errors.mean(axis=1)
    is_good = mean <= mean.min() + NEARLY
    row = int(np.where(is_good, counts.sum(axis=1), np.inf).argmin())
    parts = counts[row]
    order = [at for at in np.argsort(-parts, kind="stable") if parts[at]]
    return PaintRecipe(
        tuple(problem.paints.names[at] for at in order),
        tuple(parts[order].tolist()),
        problem.reflectance(parts),
        tuple(errors[row].tolist()),
        float(problem.paints.cost(parts)),
    )


def elsewhere(
    target: PaintTarget, paints: Paints, recipe: PaintRecipe
) -> dict[str, float]:
    """Return ΔE00 between a recipe and its target under further lights, by name: the
    index of metamerism.
    """
    known = {light.name for light in target.lights}
    lights = [paints.light(name) for name in RELIGHT_LIGHTS]
    return {
        light.name: float(
            delta_e_spectra(light, recipe.reflectance, target.reflectance)
        )
        for light in lights
        if light.name not in known
    }
