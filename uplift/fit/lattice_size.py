"""How many lattice points an atlas needs: what the lattice alone makes of the entries, before they are pinned."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.fit.entries import FittedEntries
from uplift.fit.problem import Problem
from uplift.fit.seed import seed
from uplift.lattice import Lattice
from uplift.models import evaluate

DIMS = (8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128)
"""Sizes to choose from."""
PASSES = 32


def lattice_error(
    problem: Problem, wavelengths: Array, lights: Sequence[Light], entries: FittedEntries
) -> Array:
    """ΔE00 (E,), the largest under ``lights``, between each entry's spectrum and the lattice's at its colour.

    Solves the corners of the entries' voxels alone, as a whole fit would.
    """
    lattice, seeds = problem.lattice, seed(problem.lattice, entries.rgb)
    target = lattice.points[seeds.points]
    found = problem.solve(target, entries.multipliers[seeds.entry], PASSES).multipliers
    spectra = evaluate(problem.model, found, wavelengths)
    corners, weights = lattice.corners(entries.rgb)
    order = np.argsort(seeds.points)
    place = order[np.searchsorted(seeds.points, corners, sorter=order)]
    answered = sum(weights[:, corner, None] * spectra[place[:, corner]] for corner in range(8))
    own = evaluate(problem.model, entries.multipliers, wavelengths)
    return np.max([delta_e_spectra(light, answered, own) for light in lights], axis=0)


def choose_lattice(
    problem: Problem,
    wavelengths: Array,
    lights: Sequence[Light],
    entries: FittedEntries,
    nodes: Callable[[str, int], Array],
    spacings: Iterable[str],
    within: float,
) -> tuple[str, int, int]:
    """Spacing and dim of the smallest lattice that keeps every entry, and how many it does not keep.

    An entry is kept if its `lattice_error` is ``within``; where no lattice keeps them all, the smallest of those
    that keep the most.
    """
    trials = []
    for dim in DIMS:
        for spacing in spacings:
            lattice = Lattice(nodes(spacing, dim))
            errors = lattice_error(replace(problem, lattice=lattice), wavelengths, lights, entries)
            trials.append((int((errors > within).sum()), dim, spacing))
        if not min(trials)[0]:
            break
    lost, dim, spacing = min(trials, key=lambda trial: trial[:2])
    return spacing, dim, lost
