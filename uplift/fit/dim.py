"""The smallest lattice that keeps every atlas entry, judged by the lattice without entry boxes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.common.arrays import Array
from uplift.fit.entries import FittedEntries
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem
from uplift.fit.seeds import EntryBlend, InitialGuess, seed
from uplift.lattice import Lattice, weighted_sum
from uplift.models.arithmetic import blocked_matmul

DIMS = (8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128)
"""Candidates."""
MAX_PASSES = 32


class LatticeChoice(NamedTuple):
    """Spacing of the axis nodes, nodes along each axis, and the number of entries over the tolerance."""

    axis: str
    dim: int
    lost: int


def lattice_error(problem: Problem, lattice: Lattice, prior: Prior, blend: EntryBlend, entries: FittedEntries) -> Array:
    """Largest ΔE00 (E,) under the lights between each entry's spectrum and the lattice at its colour.

    Only the corners of the entries' cells are fitted.
    """
    seeds = seed(lattice, entries.rgb)
    points = np.sort(seeds.points)
    target = lattice.points[points]
    start = InitialGuess(prior, seeds, entries.multipliers, blend)(points, target)
    fitted = problem.solve(target, start, MAX_PASSES, prior=start).multipliers
    spectra, own = (
        np.asarray(problem.model.to_reflectance(blocked_matmul(each, problem.forward.basis.T)))
        for each in (fitted, entries.multipliers)
    )
    # What the interpolation of the lattice answers at the colours of the entries
    corners, weights = lattice.corners(entries.rgb)
    answers = weighted_sum(spectra, np.searchsorted(points, corners), weights)
    return np.max([delta_e_spectra(light, answers, own) for light in problem.lights], axis=0)


def choose_lattice(
    problem: Problem,
    prior: Prior,
    blend: EntryBlend,
    entries: FittedEntries,
    axis_nodes: Callable[[str, int], Array],
    axes: Iterable[str],
    max_error: float,
) -> LatticeChoice:
    """Choose the smallest lattice that keeps every entry within ``max_error`` or, if none does, keeps the most.

    ``axis_nodes`` makes the axis nodes (dim,) of a spacing and dim; ``axes`` are the spacings to try, preferred ones
    first.
    """
    axes, trials = tuple(axes), []
    for dim in DIMS:
        for axis in axes:
            errors = lattice_error(problem, Lattice(axis_nodes(axis, dim)), prior, blend, entries)
            trials.append(LatticeChoice(axis, dim, int((errors > max_error).sum())))
        best = min(trials, key=lambda trial: (trial.lost, trial.dim))
        if not best.lost:
            break
    return best
