"""The smallest lattice that keeps every atlas entry, judged by the lattice without entry boxes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.fit.corner_share import CornerShare
from uplift.fit.entries import FittedEntries
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem
from uplift.fit.seed import seed
from uplift.fit.starts import Starts
from uplift.lattice import Lattice, weighted_sum
from uplift.models.matmul import matmul_rows

DIMS = (8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128)
"""Candidates."""
MAX_PASSES = 32


class LatticeChoice(NamedTuple):
    """The lattice that `choose_lattice` returns."""

    axis: str
    """Spacing of the axis nodes."""
    dim: int
    """Points along each axis."""
    lost: int
    """Entries over the tolerance."""


def lattice_error(
    problem: Problem, prior: Prior, corner_share: CornerShare, lights: Sequence[Light], entries: FittedEntries
) -> Array:
    """Largest ΔE00 (E,) under ``lights`` between each entry's spectrum and the lattice at its colour.

    Only the corners of the entries' cells are fitted.
    """
    lattice, model = problem.lattice, problem.model
    seeds = seed(lattice, entries.rgb)
    points = np.sort(seeds.points)
    target = lattice.points[points]
    start = Starts(prior, seeds, entries.multipliers, corner_share)(points, target)
    found = problem.solve(target, start, MAX_PASSES, prior=start).multipliers
    spectra, own = (
        np.asarray(model.squash(matmul_rows(each, problem.forward.basis.T))) for each in (found, entries.multipliers)
    )
    corners, weights = lattice.corners(entries.rgb)
    answers = weighted_sum(spectra, np.searchsorted(points, corners), weights)
    return np.max([delta_e_spectra(light, answers, own) for light in lights], axis=0)


def choose_lattice(
    problem: Problem,
    prior: Prior,
    corner_share: CornerShare,
    lights: Sequence[Light],
    entries: FittedEntries,
    axis_nodes: Callable[[str, int], Array],
    axes: Iterable[str],
    max_error: float,
) -> LatticeChoice:
    """Choose the smallest lattice that keeps every entry.

    Parameters
    ----------
    problem : Problem
        Model and solver, with any lattice.
    prior : Prior
        Prior of the lattice points.
    corner_share : CornerShare
        See `Starts`.
    lights : sequence of Light
        Lights under which errors are computed.
    entries : FittedEntries
        Atlas entries.
    axis_nodes : callable
        From the name of a spacing and dim to the axis nodes (dim,).
    axes : iterable of str
        Spacings to try, preferred ones first.
    max_error : float
        An entry is kept if its `lattice_error` is at most this ΔE00.

    Returns
    -------
    LatticeChoice
        The smallest lattice that keeps all entries or, if there is none, the smallest that keeps the most.
    """
    axes, trials = tuple(axes), []
    for dim in DIMS:
        for axis in axes:
            trial = replace(problem, lattice=Lattice(axis_nodes(axis, dim)))
            errors = lattice_error(trial, prior, corner_share, lights, entries)
            trials.append(LatticeChoice(axis, dim, int((errors > max_error).sum())))
        best = min(trials, key=lambda trial: (trial.lost, trial.dim))
        if not best.lost:
            break
    return best
