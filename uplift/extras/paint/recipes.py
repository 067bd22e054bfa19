"""Recipes: the parts of paints whose mixture comes nearest to a colour.

Every set of up to ``count`` paints is tried. The shares of a set start from a grid over
their simplex and follow damped Gauss–Newton steps, all sets at once; the three terms of
CIEDE2000 under each light are the residuals.
The best shares are then rounded to parts that one can weigh, and the neighbours in
parts are tried as well. Of up to two paints the grid is dense enough that no better
shares exist; of more, the best of several starts is not proven to be the best.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_2000_terms, lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices, blocks
from uplift.common.errors import OptionError
from uplift.extras.paint.optics import TINY
from uplift.extras.paint.paints import Paints, check_unit

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
LONGEST = 2.0
"""Largest change of a logarithm in a step."""
DAMPING = (1e-9, 1e3)
"""Limits of the damping, relative to the trace of the normal equations."""
DIFFERENCE = 1e-5
"""Change of a logarithm by which derivatives are computed."""
FIRST_DAMPING = 1e-3
"""Relative to the trace of the normal equations."""
BLOCK = 1 << 16
"""Mixtures that are computed at a time."""
KEPT = 200
"""Sets whose shares are rounded to parts."""
NEARLY = 0.1
"""ΔE00 by which a recipe of fewer parts may be worse."""


Residuals = Callable[[Array], Array]


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
    problem = _Problem.of(target, paints)
    solved = list[tuple[float, Indices, Array]]()
    for size in range(1, min(count, len(paints)) + 1):
        sets = np.array(list(combinations(range(len(paints)), size)))
        shares, squares = _solve(problem, sets)
        solved += zip(squares.tolist(), sets, shares, strict=True)
    solved.sort(key=lambda entry: entry[0])
    recipes = [
        _round(problem, members, shares, steps) for _, members, shares in solved[:KEPT]
    ]
    recipes.sort(key=lambda recipe: recipe.error)
    distinct = list[PaintRecipe]()
    for recipe in recipes:
        used = set(recipe.paints)
        if all(used != set(other.paints) for other in distinct):
            distinct.append(recipe)
    return tuple(distinct[:alternatives])


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
    sets = 1.0
    for taken in range(min(count, len(paints))):
        sets *= (len(paints) - taken) / (taken + 1)
    if sets > MAX_SETS:
        raise OptionError(
            f"{len(paints)} paints have {sets:.0f} sets of {count}, more than "
            f"{MAX_SETS}",
            code="too-many-recipes",
            hint="allow fewer paints in a mixture, or choose from fewer",
        )


@dataclass(frozen=True, eq=False)
class _Problem:
    """Mixtures (m, P) as colours (m, L, 3) under the lights of a target."""

    target: PaintTarget
    paints: Paints
    goals: Array  # (L, 3)

    @classmethod
    def of(cls, target: PaintTarget, paints: Paints) -> "_Problem":
        goals = _colours(target.reflectance, target.lights)
        return cls(target, paints, goals)

    def reflectance(self, parts: Array) -> Array:
        """Return the reflectances (m, N) of mixtures by parts (m, P)."""
        target = self.target
        return self.paints.reflectance(parts, target.thickness, target.ground)

    def residuals(self, parts: Array) -> Array:
        """Return the differences (m, 3 L) of mixtures to the target: terms of ΔE00."""
        pieces = []
        for rows in blocks(len(parts), BLOCK):
            colours = _colours(self.reflectance(parts[rows]), self.target.lights)
            differences = delta_e_2000_terms(colours, self.goals)
            pieces.append(differences.reshape(len(colours), -1))
        return np.concatenate(pieces)

    def errors(self, parts: Array) -> Array:
        """Return ΔE00 (m, L) between mixtures and the target."""
        colours = _colours(self.reflectance(parts), self.target.lights)
        return delta_e_2000(colours, self.goals)

    def spread(self, sets: Indices, shares: Array) -> Array:
        """Return shares (m, k) of sets of paints (m, k) as parts of all, (m, P)."""
        parts = np.zeros((len(sets), len(self.paints)))
        np.put_along_axis(parts, sets, shares, axis=1)
        return parts


def _colours(reflectance: Array, lights: Sequence[Light]) -> Array:
    """Return CIE L*a*b* (…, L, 3) of reflectances (…, N) under each light."""
    colours = [lab(reflectance @ light.xyz.T, light.white) for light in lights]
    return np.stack(colours, axis=-2)


def _solve(problem: _Problem, sets: Indices) -> tuple[Array, Array]:
    """Return the best shares (m, k) of sets of paints (m, k), and their errors (m,)."""
    size = sets.shape[1]
    levels = FINE if size == 2 else LEVELS if size == 3 else COARSE
    grid = np.array(list(product(levels, repeat=size - 1)), dtype=float)
    repeated = np.repeat(sets, len(grid), axis=0)
    starts = np.tile(grid, (len(sets), 1))
    tried = problem.residuals(problem.spread(repeated, shares_of(starts)))
    sums = (tried**2).sum(axis=1).reshape(len(sets), len(grid))
    best = np.argsort(sums, axis=1)[:, :STARTS]
    followed = np.repeat(sets, best.shape[1], axis=0)

    def residuals(ratios: Array) -> Array:
        return problem.residuals(problem.spread(followed, shares_of(ratios)))

    ratios, squares = descend(residuals, grid[best.ravel()])
    squares = squares.reshape(best.shape)
    chosen = squares.argmin(axis=1)
    ratios = ratios.reshape(*best.shape, size - 1)[np.arange(len(sets)), chosen]
    return shares_of(ratios), squares.min(axis=1)


def descend(residuals: Residuals, ratios: Array) -> tuple[Array, Array]:
    """Follow Levenberg–Marquardt steps from logarithms of ratios (m, k − 1) to those
    of a smaller sum of squares, and return both.

    ``residuals`` maps them to residuals (m, r), each row independently.
    """
    values = residuals(ratios)
    squares = (values**2).sum(axis=1)
    damping = np.full(len(ratios), FIRST_DAMPING)
    count = ratios.shape[1]
    for _ in range(STEPS if count else 0):
        columns = []
        for column in range(count):
            moved = ratios + DIFFERENCE * np.eye(count)[column]
            columns.append((residuals(moved) - values) / DIFFERENCE)
        jacobian = np.stack(columns, axis=2)
        normal = jacobian.mT @ jacobian
        scale = np.trace(normal, axis1=1, axis2=2) + TINY
        damped = normal + (damping * scale)[:, None, None] * np.eye(count)
        slope = (jacobian.mT @ values[..., None])[..., 0]
        step = np.linalg.solve(damped, -slope[..., None])[..., 0]
        limited = np.clip(step, -LONGEST, LONGEST)
        trial = np.clip(ratios + limited, -LARGEST, LARGEST)
        changed = residuals(trial)
        trial_squares = (changed**2).sum(axis=1)
        is_better = trial_squares < squares
        ratios = np.where(is_better[:, None], trial, ratios)
        values = np.where(is_better[:, None], changed, values)
        squares = np.where(is_better, trial_squares, squares)
        damping = np.clip(damping * np.where(is_better, 0.2, 8), *DAMPING)
    return ratios, squares


def shares_of(ratios: Array) -> Array:
    """Return shares (m, k) of logarithms (m, k − 1) of their ratios to the first."""
    logarithms = np.concatenate([np.zeros((len(ratios), 1)), ratios], axis=1)
    weights = np.exp(logarithms - logarithms.max(axis=1, keepdims=True))
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _round(
    problem: _Problem, members: Indices, shares: Array, steps: int
) -> PaintRecipe:
    """Return the recipe of the fewest parts that is nearly as good as any of up to
    ``steps`` parts.
    """
    totals = np.arange(1, steps + 1)[:, None]
    counts = np.unique(np.rint(totals * shares), axis=0)
    counts = counts[(counts.sum(axis=1) <= steps) & counts.any(axis=1)]
    divisors = np.gcd.reduce(counts.astype(int), axis=1)
    counts = np.unique(counts / divisors[:, None], axis=0)
    sets = np.broadcast_to(members, counts.shape)
    parts = problem.spread(sets, counts)
    errors = problem.errors(parts)
    mean = errors.mean(axis=1)
    is_good = mean <= mean.min() + NEARLY
    fewest = np.where(is_good, counts.sum(axis=1), np.inf)
    row = int(fewest.argmin())
    order = [at for at in np.argsort(-counts[row], kind="stable") if counts[row, at]]
    return PaintRecipe(
        tuple(problem.paints.names[members[at]] for at in order),
        tuple(int(counts[row, at]) for at in order),
        problem.reflectance(parts[row]),
        tuple(errors[row].tolist()),
        float(problem.paints.cost(parts[row])),
    )
