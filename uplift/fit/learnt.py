"""The learnt base: smooth spectra plus the deviation that families of measured materials have from them.

Deviations are kriged relative to the brightening of smooth spectra, so that dark colours stay dark, on the nodes of
their table. With an atlas, the relevance of each family is learnt: how well its contribution predicts the entries
(docs/prior.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Mask
from uplift.fit.base import Base
from uplift.fit.entries import FittedEntries
from uplift.fit.family_kriging import FamilyKriging, FamilySamples, average_close, krige_families
from uplift.fit.library import Family
from uplift.fit.match_spectra import match_spectra
from uplift.fit.prior import MARGIN
from uplift.fit.problem import Problem
from uplift.fit.quadrature_jit import COMPILED
from uplift.fit.relevance import learn_relevance
from uplift.fit.smooth import MIN_LEVEL, NO_FREEDOM, TABLE, Smooth
from uplift.fit.smooth import smooth as make_smooth
from uplift.fit.unrealisable import unrealisable
from uplift.models import Model, Moments, evaluate
from uplift.models.real_moments import dual

SAME_COLOUR, SAME_SPECTRUM = 6.0, 0.03
"""ΔE*ab and rms within which a spectrum of a library is that of an atlas entry, which replaces it."""
MAX_ENTRIES = 1000
"""Entries from which relevances are learnt."""
BOUND = 0.1
"""Part of the distance of a smooth spectrum from 0 and 1 that always remains."""
DIMMEST = 0.1
"""Brightened colours below this, linear RGB under 0.01, tend towards smooth spectra: hardly anything is so dark."""


@dataclass(frozen=True, eq=False, repr=False)
class LearntBase:
    """A learnt base, and how relevant each family was.

    Parameters
    ----------
    base : Base
        Predictor of spectra.
    relevance : tuple of float
        Factor of the contribution of each family, 0 to 4, 1 without an atlas.
    """

    base: Base
    relevance: tuple[float, ...]


def learn_base(
    problem: Problem,
    sensor: Sensor,
    lights: Sequence[Light],
    families: Sequence[Family],
    entries: FittedEntries,
) -> LearntBase:
    """Learn the base from libraries, and their relevance from atlas entries.

    Parameters
    ----------
    problem : Problem
        Spectrum model and solver.
    sensor : Sensor
        RGB space of the colours.
    lights : sequence of Light
        Lights under which colours should be kept.
    families : sequence of Family
        Libraries. Spectra out of gamut, and those of atlas entries, are not used.
    entries : FittedEntries
        Atlas entries.

    Returns
    -------
    LearntBase
        The base; that of smooth spectra without families, and for models without freedom.
    """
    outside = unrealisable(TABLE, sensor, MARGIN)
    smooth = make_smooth(problem.model, problem.forward, outside=outside)
    model = problem.model
    if not families or smooth.nodes is None or not isinstance(model, Moments):
        return LearntBase(smooth, (1.0,) * len(families))
    kriging = krige_families([_samples(smooth, sensor, family, entries) for family in families])
    relevance = _relevance(smooth, sensor, lights, kriging, entries)
    plain = evaluate(model, model.from_storage(smooth.nodes), sensor.wavelengths)
    bright = smooth.table.points.copy()
    bright[outside.points] = outside.nearest
    deviations = _deviations(smooth, sensor, kriging, relevance, bright)
    goal = np.clip(plain + deviations, BOUND * plain, 1 - BOUND * (1 - plain))
    factor = _brightening(smooth, _darkened(smooth, bright))
    nodes = _match_nodes(model, sensor, lights, goal, factor)
    return LearntBase(replace(smooth, nodes=nodes), tuple(relevance.tolist()))


def has_freedom(model: Model) -> bool:
    """Determine whether a model has several spectra of one colour, so that the prior matters.

    Parameters
    ----------
    model : Model
        Spectrum model.

    Returns
    -------
    bool
        False for models of three coefficients.
    """
    return isinstance(model, Moments) and model.count > NO_FREEDOM


def _samples(smooth: Smooth, sensor: Sensor, family: Family, entries: FittedEntries) -> FamilySamples:
    rgb = sensor.rgb(family.measured)
    rows = np.flatnonzero(sensor.contains(rgb))
    rgb, measured = np.clip(rgb[rows], 0, 1), family.measured[rows]
    locations = rgb_to_lab(sensor, rgb)
    new = ~_duplicates(locations, measured, rgb_to_lab(sensor, entries.rgb), entries.measured)
    rgb, measured, locations = rgb[new], measured[new], locations[new]
    deviations = (measured - _spectra(smooth, sensor, rgb)) / _brightening(smooth, rgb)
    return FamilySamples(*average_close(locations, deviations), family.spread, family.related)


def _duplicates(locations: Array, measured: Array, of_locations: Array, of_measured: Array) -> Mask:
    """Whether each spectrum is that of an entry (n,)."""
    from scipy.spatial import cKDTree

    found = np.zeros(len(locations), dtype=bool)
    if not len(of_locations) or not len(locations):
        return found
    for row, near in enumerate(cKDTree(of_locations).query_ball_point(locations, SAME_COLOUR)):
        squared = ((of_measured[near] - measured[row]) ** 2).mean(axis=1)
        found[row] = bool((squared <= SAME_SPECTRUM**2).any())
    return found


def _spectra(smooth: Smooth, sensor: Sensor, rgb: Array) -> Array:
    return evaluate(smooth.model, smooth(rgb), sensor.wavelengths)


def _brightening(smooth: Smooth, rgb: Array) -> Array:
    """Factor (n, 1) between a colour and the brightened one."""
    return np.asarray(np.maximum(rgb.max(axis=1), MIN_LEVEL)[:, None] ** smooth.brightening)


def _relevance(
    smooth: Smooth, sensor: Sensor, lights: Sequence[Light], kriging: FamilyKriging, entries: FittedEntries
) -> Array:
    order = np.lexsort(entries.rgb.T)
    order = order[:: max(-(-len(order) // MAX_ENTRIES), 1)]
    rgb = entries.rgb[order]
    locations = rgb_to_lab(sensor, rgb)
    parts = kriging.contributions(locations) * _brightening(smooth, rgb)
    return learn_relevance(lights, locations, _spectra(smooth, sensor, rgb), parts, entries.measured[order])


def _match_nodes(model: Moments, sensor: Sensor, lights: Sequence[Light], goal: Array, factor: Array) -> Array:
    """Coefficients (n, C) of brightened spectra, close to ``goal`` (n, N).

    They are matched at the actual brightness, ``factor`` (n, 1) of the brightened one. Where the result cannot be
    brightened, as no reflectance has such moments, the brightened spectrum is matched instead.
    """

    def match(spectra: Array) -> Array:
        multipliers = match_spectra(model, sensor.wavelengths, spectra, lights)
        return model.to_storage(multipliers, COMPILED)

    nodes = match(goal * factor) / factor
    _, valid = dual(nodes)
    nodes[~valid] = match(goal[~valid])
    return nodes


def _deviations(smooth: Smooth, sensor: Sensor, kriging: FamilyKriging, relevance: Array, bright: Array) -> Array:
    """Deviations (n, N) of brightened spectra at brightened colours (n, 3)."""
    deviations = kriging(rgb_to_lab(sensor, _darkened(smooth, bright)), relevance)
    return np.asarray(deviations * np.minimum(bright.max(axis=1, keepdims=True) / DIMMEST, 1))


def _darkened(smooth: Smooth, bright: Array) -> Array:
    """Colours (n, 3) of brightened ones."""
    power = smooth.brightening / (1 - smooth.brightening)
    return np.asarray(bright * bright.max(axis=1, keepdims=True) ** power)
