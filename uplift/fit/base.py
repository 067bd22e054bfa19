"""Base spectra: what the prior expects of a colour where no atlas entry is near (docs/mathematics.md, 7).

Smooth spectra: multipliers have no upper bound on slope, so that from them alone a dark red rises to a reflectance of 1
outside the range of the colour-matching functions. So a colour x starts from a brighter one, x' = x / k with
k = √max(x). It is solved from a grey by minimum-norm steps, and its spectrum is scaled by k (docs/fidelity.md).

The learnt base adds the deviation that families of measured materials have from smooth spectra (docs/prior.md). It is
kriged relative to the brightening, so that dark colours stay dark, at the nodes of the table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.common.arrays import Array, Mask
from uplift.fit.batch import to_storage
from uplift.fit.entries import FittedEntries
from uplift.fit.families import Family, FamilySamples, average_close, krige_families, learn_relevance
from uplift.fit.match_spectra import match_spectra
from uplift.fit.problem import Problem, nodes_of
from uplift.fit.solver import solve
from uplift.lattice import Lattice, weighted_sum
from uplift.models import Moments, evaluate
from uplift.models.minimum_norm import ForwardMap
from uplift.models.model import Model

BRIGHTENING = 0.5
"""Power of max(x) that a colour is divided by: 0 leaves it unchanged, 1 makes it as bright as possible."""
GREY = 2 / 3
"""Power of the mean of x' that gives the reflectance of the grey to start from."""
TABLE = Lattice(np.linspace(0, 1, 17) ** 2)
MIN_LEVEL, MAX_LEVEL = 1e-4, 0.98
NO_FREEDOM = 3
"""Number of coefficients that the colour alone determines."""
MARGIN = 1e-3
"""Linear RGB between the goals of unrealisable colours and the boundary, where spectra become boxes."""
SAME_COLOUR, SAME_SPECTRUM = 6.0, 0.03
"""ΔE*ab and rms within which a spectrum of a library is that of an atlas entry, which replaces it."""
MAX_ENTRIES = 1000
"""Entries from which relevances are learnt."""
BOUND = 0.1
"""Part of the distance of a smooth spectrum from 0 and 1 that always remains."""
DIMMEST = 0.1
"""Brightened colours below this, linear RGB under 0.01, tend towards smooth spectra: hardly anything is so dark."""


@dataclass(frozen=True, eq=False)
class Base:
    """Base spectra from coefficients (17³, C) of brightened colours in `TABLE`; greys where ``nodes`` is None.

    Coefficients of the moments model are moments of reflectances in (0, 1), so weighted means of several are valid.
    """

    model: Model
    nodes: Array | None
    brightening: float = BRIGHTENING
    grey: float = GREY

    def __call__(self, rgb: Array) -> Array:
        """Multipliers (n, C) of nearly the colours (n, 3), linear RGB in [0, 1], for the solver to finish."""
        return self.model.from_storage(self.coefficients(rgb))

    def coefficients(self, rgb: Array) -> Array:
        """Coefficients (n, C) of nearly the colours (n, 3), continuous in them."""
        if self.nodes is None:
            return self.model.to_storage(_grey(self.model, rgb, self.grey))
        factor = self.brightness(rgb)
        return factor * weighted_sum(self.nodes, *TABLE.corners(np.minimum(rgb / factor, 1)))

    def brightness(self, rgb: Array) -> Array:
        """Factor k (n, 1) between a colour and the brightened one."""
        return np.asarray(np.maximum(rgb.max(axis=1), MIN_LEVEL)[:, None] ** self.brightening)

    def darkened(self, bright: Array) -> Array:
        """Colours (n, 3) of brightened ones."""
        power = self.brightening / (1 - self.brightening)
        return np.asarray(bright * bright.max(axis=1, keepdims=True) ** power)


def has_freedom(model: Model) -> bool:
    """Whether a model has several spectra of one colour, so that the prior matters."""
    return isinstance(model, Moments) and model.count > NO_FREEDOM


def smooth(
    model: Model,
    forward: ForwardMap,
    goal: Array = TABLE.points,
    brightening: float = BRIGHTENING,
    grey: float = GREY,
) -> Base:
    """Solve the table for smooth spectra of brightened colours ``goal`` (17³, 3), each from its grey."""
    if model.count == NO_FREEDOM:
        return Base(model, None, brightening, grey)
    solution = solve(forward, _grey(model, goal, grey), goal, tolerance=1e-5, max_passes=8)
    return Base(model, to_storage(model, solution.multipliers), brightening, grey)


def _grey(model: Model, rgb: Array, power: float) -> Array:
    # mean(x′)^⅔, as multipliers of a constant
    level = np.clip(rgb.mean(axis=1) ** power, MIN_LEVEL, MAX_LEVEL)
    return model.from_reflectance(level)[:, None] * model.constant()


def learn_base(
    problem: Problem, families: Sequence[Family] = (), entries: FittedEntries | None = None
) -> tuple[Base, tuple[float, ...]]:
    """Learn the base from families, and the relevance of each, 0 to 4, from atlas entries; 1 without an atlas.

    Spectra out of gamut, and those of atlas entries, are not used. The base is that of smooth spectra without families,
    and for models without freedom.
    """
    # Unrealisable nodes of the table are solved for the nearest realisable colours: their own multipliers would be
    # arbitrary, and would spoil the interpolation between nodes.
    table = nodes_of(TABLE, problem.sensor, MARGIN)
    bright = table.goal(table.points)
    plain = smooth(problem.model, problem.forward, bright)  # s(x′)
    model, sensor = problem.model, problem.sensor
    if not families or plain.nodes is None or not isinstance(model, Moments):
        return plain, (1.0,) * len(families)
    kriging = krige_families([_samples(plain, problem, family, entries) for family in families])

    relevance = np.ones(len(families))
    if entries is not None:
        order = np.lexsort(entries.rgb.T)
        order = order[:: max(-(-len(order) // MAX_ENTRIES), 1)]
        rgb = entries.rgb[order]
        locations = rgb_to_lab(sensor, rgb)
        expected = evaluate(model, plain(rgb), sensor.wavelengths)
        parts = kriging.contributions(locations) * plain.brightness(rgb)
        relevance = learn_relevance(problem.lights, locations, expected, parts, entries.measured[order])

    # s(x′) + d(x) / k at the nodes x′ of the table, inside (0, 1), as coefficients
    spectra = evaluate(model, model.from_storage(plain.nodes), sensor.wavelengths)
    colours = plain.darkened(bright)
    deviations = kriging(rgb_to_lab(sensor, colours), relevance)
    deviations = deviations * np.minimum(bright.max(axis=1, keepdims=True) / DIMMEST, 1)
    goal = np.clip(spectra + deviations, BOUND * spectra, 1 - BOUND * (1 - spectra))
    nodes = _match_nodes(problem, model, goal, plain.brightness(colours))
    return replace(plain, nodes=nodes), tuple(relevance.tolist())


def _samples(plain: Base, problem: Problem, family: Family, entries: FittedEntries | None) -> FamilySamples:
    """Deviations of the spectra of a family from smooth ones, brightened."""
    sensor = problem.sensor
    rgb = sensor.rgb(family.measured)
    rows = np.flatnonzero(sensor.contains(rgb))
    rgb, measured = np.clip(rgb[rows], 0, 1), family.measured[rows]
    locations = rgb_to_lab(sensor, rgb)
    if entries is not None:
        new = ~_duplicates(locations, measured, rgb_to_lab(sensor, entries.rgb), entries.measured)
        rgb, measured, locations = rgb[new], measured[new], locations[new]
    expected = evaluate(plain.model, plain(rgb), sensor.wavelengths)
    deviations = (measured - expected) / plain.brightness(rgb)
    return FamilySamples(*average_close(locations, deviations), family.spread, family.related)


def _duplicates(locations: Array, measured: Array, of_locations: Array, of_measured: Array) -> Mask:
    """Whether each spectrum (n,) is that of an entry."""
    from scipy.spatial import cKDTree

    duplicate = np.zeros(len(locations), dtype=bool)
    if not len(of_locations) or not len(locations):
        return duplicate
    for row, near in enumerate(cKDTree(of_locations).query_ball_point(locations, SAME_COLOUR)):
        squared = ((of_measured[near] - measured[row]) ** 2).mean(axis=1)
        duplicate[row] = bool((squared <= SAME_SPECTRUM**2).any())
    return duplicate


def _match_nodes(problem: Problem, model: Moments, goal: Array, factor: Array) -> Array:
    """Coefficients (n, C) of brightened spectra, close to ``goal`` (n, N).

    They are matched at the actual brightness, ``factor`` (n, 1) of the brightened one. Where the result cannot be
    brightened, as no reflectance has such moments, the brightened spectrum is matched instead.
    """
    wavelengths, lights = problem.sensor.wavelengths, problem.lights
    nodes = to_storage(model, match_spectra(model, wavelengths, goal * factor, lights)) / factor
    _, valid = model.try_from_storage(nodes)
    nodes[~valid] = to_storage(model, match_spectra(model, wavelengths, goal[~valid], lights))
    return nodes
