"""Base spectra: what the prior expects of a colour where no atlas entry is near
(docs/mathematics.md, 7).

Smooth spectra: multipliers have no upper bound on slope, so that from them alone a dark
red rises to a reflectance of 1 outside the range of the colour-matching functions. So a
colour x starts from a brighter one, x' = x / k with k = √max(x). It is solved from a
grey by minimum-norm steps, and its spectrum is scaled by k.

The learnt base adds the deviation that families of measured materials have from smooth
spectra (docs/prior.md). It is kriged relative to the brightening, so that dark colours
stay dark, at the nodes of the table.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from importlib.resources import files

import numpy as np

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.sensor import Light, in_unit_cube
from uplift.common.arrays import Array, blocks, distances
from uplift.fit.batch import to_storage
from uplift.fit.entries import FittedEntries, objective
from uplift.fit.families import FILE, Family, krige_families, learn_relevance
from uplift.fit.kriging import Points, average_close
from uplift.fit.problem import Problem, nodes_of
from uplift.fit.solver import solve
from uplift.lattice.lattice import Lattice, weighted_sum
from uplift.models.arithmetic import blocked_matmul
from uplift.models.brightness import BRIGHTENING, MIN_LEVEL, brightness
from uplift.models.minimum_norm import ForwardMap
from uplift.models.model import Model, reflectance

# also imported from here
from uplift.models.moments import Moments, moment_matrix

GREY = 2 / 3
"""Power of the mean of x' that gives the reflectance of the grey to start from."""
TABLE = Lattice(np.linspace(0, 1, 17) ** 2)
MAX_LEVEL = 0.98
SAME_SENSOR = 1e-14
"""Difference of elements of W up to which a stored table is that of a sensor: they
differ between instruction sets.
"""
SAME_COLOUR = 6.0
"""ΔE*ab within which a spectrum of a library may be that of an atlas entry."""
SAME_SPECTRUM = 0.03
"""Their rms difference within which the entry then replaces it."""
MAX_ENTRIES = 1000
"""Entries from which relevances are learnt, at most."""
BOUND = 0.1
"""Part of the distance of a smooth spectrum from 0 and 1 that always remains."""
COLOUR_WEIGHT = 0.06
"""Weight of a unit of CIE L*a*b* under a light: twice that of atlas entries, as the
spectra are uncertain.
"""
DAMPING = 1e-4
"""Damping of the step, relative to the mean diagonal of its matrix."""
MATCH_ROWS = 1 << 9
DIMMEST = 0.1
"""Brightened colours below this, linear RGB under 0.01, tend towards smooth spectra:
hardly anything is so dark.
"""


@dataclass(frozen=True, eq=False)
class Base:
    """Base spectra from coefficients (17³, C) of brightened colours in `TABLE`; greys
    where ``nodes`` is None.

    Coefficients of the moments model are moments of reflectances in (0, 1), so weighted
    means of several are valid.
    """

    model: Model
    nodes: Array | None

    def coefficients(self, rgb: Array) -> Array:
        """Coefficients (n, C) of nearly the linear RGB (n, 3) in [0, 1], continuous in
        it; the solver does the rest.
        """
        if self.nodes is None:
            return self.model.to_storage(_grey(self.model, rgb))
        # s(x) = k s(x / k), as moments are linear in the spectrum
        factor = brightness(rgb)
        return factor * weighted_sum(
            self.nodes, *TABLE.corners(np.minimum(rgb / factor, 1))
        )


@lru_cache(maxsize=1)
def smooth_base(problem: Problem) -> tuple[Base, Array]:
    """Return the base of smooth spectra, and the colours (17³, 3) of its nodes.

    Unrealisable nodes of the table are solved for realisable colours of less chroma:
    their own multipliers would be arbitrary, and would spoil the interpolation between
    nodes.
    """
    table = nodes_of(TABLE, problem.sensor)
    bright = table.goal(table.points)
    return smooth_table(problem, bright), bright


def smooth_table(problem: Problem, goal: Array) -> Base:
    """Smooth spectra of colours ``goal`` (17³, 3): those in `FILE`, if it has the model
    and sensor, or solved.
    """
    sensor = problem.sensor
    if problem.model == Moments():
        with (
            (files(__package__) / FILE).open("rb") as file,
            np.load(file, allow_pickle=False) as stored,
        ):
            for number, matrix in enumerate(stored["matrices"]):
                if sensor.matrix.shape == matrix.shape and np.allclose(
                    sensor.matrix, matrix, rtol=0, atol=SAME_SENSOR
                ):
                    return Base(problem.model, stored[f"smooth{number}"])
    return smooth(problem.model, problem.forward, goal)


def smooth(model: Model, forward: ForwardMap, goal: Array | None = None) -> Base:
    """Solve the table for smooth spectra of brightened colours ``goal`` (17³, 3), its
    nodes by default.
    """
    if model.is_determined:
        return Base(model, None)
    goal = TABLE.points if goal is None else goal  # each is solved from its grey
    solution = solve(forward, _grey(model, goal), goal, tolerance=1e-5, max_passes=8)
    return Base(model, to_storage(model, solution.multipliers))


def _grey(model: Model, rgb: Array) -> Array:
    # mean(x′)^⅔, as multipliers of a constant
    level = np.clip(rgb.mean(axis=1) ** GREY, MIN_LEVEL, MAX_LEVEL)
    return model.from_reflectance(level)[:, None] * model.constant()


def learn_base(
    problem: Problem,
    families: Sequence[Family] = (),
    entries: FittedEntries | None = None,
) -> tuple[Base, tuple[float, ...]]:
    """Learn the base from families, and the relevance of each, 0 to 4, from atlas
    entries; 1 without an atlas.

    Spectra out of gamut, and those of atlas entries, are not used. The base is that of
    smooth spectra without families, and for models whose spectra the colour alone
    determines.
    """
    plain, bright = smooth_base(problem)  # s(x′)
    model = problem.model
    sensor = problem.sensor
    if not families or plain.nodes is None or not isinstance(model, Moments):
        return plain, (1.0,) * len(families)
    samples = [
        family_samples(plain, problem, family.measured, entries) for family in families
    ]
    kriging = krige_families(families, samples)

    relevance = np.ones(len(families))
    if entries is not None:
        order = np.lexsort(entries.rgb.T)
        order = order[:: max(-(-len(order) // MAX_ENTRIES), 1)]
        rgb = entries.rgb[order]
        locations = rgb_to_lab(sensor, rgb)
        expected = reflectance(model, plain.coefficients(rgb), sensor.wavelengths)
        parts = kriging.contributions(locations) * brightness(rgb)
        relevance = learn_relevance(
            problem.lights, locations, expected, parts, entries.measured[order]
        )

    expected_deviation = partial(kriging, relevance=relevance)
    nodes = learnt_coefficients(problem, model, plain.nodes, expected_deviation, bright)
    return replace(plain, nodes=nodes), tuple(relevance.tolist())


def learnt_coefficients(
    problem: Problem,
    model: Moments,
    smooth: Array,
    expected_deviation: Callable[[Array], Array],
    bright: Array,
) -> Array:
    """Coefficients (n, C) of brightened colours x′ (n, 3): those of ``smooth`` spectra
    (n, C) that deviate as is expected at L*a*b*.
    """
    # s(x′) + d(x) / k inside (0, 1), as coefficients, where x = x′ max(x′)
    sensor = problem.sensor
    spectra = reflectance(model, smooth, sensor.wavelengths)
    brightest = bright.max(axis=1, keepdims=True)
    colours = bright * brightest ** (BRIGHTENING / (1 - BRIGHTENING))
    deviations = expected_deviation(rgb_to_lab(sensor, colours))
    deviations = deviations * np.minimum(brightest / DIMMEST, 1)
    goal = np.clip(spectra + deviations, BOUND * spectra, 1 - BOUND * (1 - spectra))
    # Spectra are matched at their actual brightness. Where the result cannot be
    # brightened, as no reflectance has such moments, the brightened spectrum is matched
    # instead.
    factor = brightness(colours)
    matched = match_spectra(model, sensor.wavelengths, goal * factor, problem.lights)
    coefficients = to_storage(model, matched) / factor
    _, valid = model.try_from_storage(coefficients)
    again = match_spectra(model, sensor.wavelengths, goal[~valid], problem.lights)
    coefficients[~valid] = to_storage(model, again)
    return coefficients


def family_samples(
    plain: Base, problem: Problem, measured: Array, entries: FittedEntries | None
) -> Points:
    """Deviations of the spectra (E, N) from smooth ones, brightened, without those of
    atlas entries.
    """
    sensor = problem.sensor
    rgb = sensor.rgb(measured)
    rows = np.flatnonzero(in_unit_cube(rgb))
    rgb = np.clip(rgb[rows], 0, 1)
    measured = measured[rows]
    locations = rgb_to_lab(sensor, rgb)
    if entries is not None:
        close = distances(locations, rgb_to_lab(sensor, entries.rgb)) <= SAME_COLOUR
        new = np.ones(len(rgb), dtype=bool)
        for row, near in enumerate(close):
            squares = ((entries.measured[near] - measured[row]) ** 2).mean(axis=1)
            new[row] = squares.min(initial=np.inf) > SAME_SPECTRUM**2
        rgb = rgb[new]
        measured = measured[new]
        locations = locations[new]
    expected = reflectance(plain.model, plain.coefficients(rgb), sensor.wavelengths)
    deviations = (measured - expected) / brightness(rgb)
    return average_close(locations, deviations)


def match_spectra(
    model: Moments, wavelengths: Array, reflectances: Array, lights: Sequence[Light]
) -> Array:
    """Multipliers (n, C) of spectra near reflectances (n, N) in (0, 1), with nearly
    their colours under several lights.

    The wavelengths (N,) are evenly spaced over the range of the model. The moments of a
    detailed reflectance lose its colour under other lights if they are few. One
    Gauss–Newton step of the objective (6) restores it; spectra that it would not bring
    nearer stay.
    """
    goal = objective(
        model, model.basis(wavelengths), lights, COLOUR_WEIGHT, smoothness=None
    )
    multipliers = model.from_storage(
        blocked_matmul(reflectances, moment_matrix(model, wavelengths))
    )
    for block in blocks(len(multipliers), MATCH_ROWS):
        p = multipliers[block]
        measured = reflectances[block]
        colours = goal.colours(measured)
        # p − (JᵀJ + μ I)⁻¹ Jᵀ r minimises mean (g − m)² + Σ |w ΔL*a*b*|², linearised
        residual = goal.residuals(p, measured, colours)
        matrix, slope = goal.normal_equations(p, residual)
        damping = DAMPING * np.trace(matrix, axis1=1, axis2=2) / model.count
        matrix += damping[:, None, None] * np.eye(model.count)
        trial = p - np.linalg.solve(matrix, slope[..., None])[..., 0]
        left = goal.residuals(trial, measured, colours)
        better = (left**2).sum(axis=1) < (residual**2).sum(axis=1)
        p[better] = trial[better]
    return multipliers
