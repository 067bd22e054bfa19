"""Atlas entries in a lattice: the widths of their boxes, seeds, the multipliers that
nodes start from, and the lattice that keeps all entries.

Tódová 2020, "Constrained spectral uplifting", section 3.1.2; docs/mathematics.md, 6.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_1976, delta_e_spectra, rgb_to_lab
from uplift.common.arrays import Array, Indices, Mask
from uplift.fit.entries import FittedEntries
from uplift.fit.neighbours import nearest_other
from uplift.fit.prior import Prior, blended
from uplift.fit.problem import Problem
from uplift.lattice.lattice import AXES, CORNERS, Lattice, axis_nodes, weighted_sum
from uplift.models.model import evaluate

NEAR = 8.0
"""ΔE*ab up to which a corner is near its entry."""
FAR = 16.0
"""ΔE*ab from which a corner is far from its entry."""
CODES = 255
GENTLE_STEP = 0.2
"""ΔE00 by which an 8-bit step between nodes may change because one starts from an
entry.
"""
TINY = 1e-9
CORNER_SHARE = 0.8
"""Weight of an entry in the start of near corners, if no other entry is close."""
MAX_HALF_WIDTH = 1.0
"""Lattice steps: the half width of an entry box without other entries nearby."""
DIMS = (8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128)
"""Lattices that `choose_lattice` tries."""
MAX_PASSES = 32


def half_widths(steps: Array) -> Array:
    """Half widths (E,), 0 to 1, of the boxes around entries at positions (E, 3), all in
    lattice steps.

    No two boxes overlap: a box extends at most half the distance to the nearest other
    entry (docs/mathematics.md, 8).
    """
    return np.minimum(MAX_HALF_WIDTH, nearest_other(steps, np.inf) / 2)


def outside_half_widths(lattice: Lattice, rgb: Array) -> Array:
    """Half widths (O,) of the boxes around entries outside [0, 1], in lattice steps of
    1 / (dim − 1), as `half_widths`.

    A box ends at [0, 1].
    """
    steps = rgb * (lattice.dim - 1)
    return np.minimum(
        half_widths(steps),
        np.abs(steps - np.clip(steps, 0, lattice.dim - 1)).max(axis=1),
    )


@dataclass(frozen=True, eq=False, repr=False)
class Seeds:
    """Nodes (S,) that start from the entries (S,) of linear RGB (E, 3).

    ``primary`` (S,) marks the node nearest to its entry. ``crowded`` are entries whose
    nearest node a closer one has. ``half_width`` (E,) are those of the boxes.
    """

    lattice: Lattice
    rgb: Array
    half_width: Array
    points: Indices
    entry: Indices
    primary: Mask
    crowded: tuple[int, ...]


def seed(lattice: Lattice, rgb: Array) -> Seeds:
    """Assign nodes to atlas entries of linear RGB (E, 3), independently of the order of
    entries of different colours.

    Every entry gets its nearest node, unless a closer entry owns it. Then, in rounds,
    every entry gets the nearest free corner of its cell: the "better approach" of
    Tódová 2020, section 3.1.2.
    """
    cells = lattice.cell_corners(lattice.cell(rgb)[0])
    distance = np.linalg.norm(lattice.target(cells) - rgb[:, None, :], axis=-1)
    by_distance = np.argsort(distance, axis=1, kind="stable")
    queue = np.take_along_axis(cells, by_distance, axis=1)
    nearest = np.take_along_axis(distance, by_distance, axis=1)[:, 0]
    order = np.lexsort([*rgb.T, nearest])
    owner: dict[int, int] = {}
    crowded = []
    for entry in order:
        first = owner.setdefault(int(queue[entry, 0]), int(entry))
        if first != entry:
            crowded.append(int(entry))
    # Then the corners of the cells, one for every entry in turn, nearest first.
    primaries = len(owner)
    for _ in CORNERS:
        for entry in order:
            free = next(
                (int(point) for point in queue[entry] if point not in owner), None
            )
            if free is not None:
                owner[free] = int(entry)
    return Seeds(
        lattice=lattice,
        rgb=rgb,
        half_width=half_widths(lattice.to_steps(rgb)),
        points=np.array(list(owner), dtype=np.int64),
        entry=np.array(list(owner.values()), dtype=np.int64),
        primary=np.arange(len(owner)) < primaries,
        crowded=tuple(crowded),
    )


Blend = Callable[[Prior, Seeds, Indices, Array], Array]
"""From the ΔE*ab (k,) between corners and their entries, rows (k,), to the weights (k,)
of entries in the start of the corners. The rest is the prior.
"""


def near_entry(prior: Prior, seeds: Seeds, entry: Indices, distance: Array) -> Array:
    """The default: shades of an entry, paint of nearly its colour, are like it, other
    materials near it like the prior.

    The weight is smaller where others are close, and for entries that surprise: nodes
    that differ much from their neighbours would show as spots under other lights.
    """
    share = CORNER_SHARE * np.interp(distance, (NEAR, FAR), (1, 0))
    share *= seeds.half_width[entry]
    if prior.surprise is not None:
        node_codes = CODES / (seeds.lattice.dim - 1)
        gentle = GENTLE_STEP * node_codes / np.maximum(prior.surprise, TINY)
        share *= np.minimum(gentle, 1)[entry]
    return share


def full_entry(prior: Prior, seeds: Seeds, entry: Indices, distance: Array) -> Array:
    """Tódová 2020, section 3.1.2."""
    return np.ones_like(distance)


def initial_guess(
    points: Indices,
    rgb: Array,
    prior: Prior,
    seeds: Seeds,
    entries: Array,
    blend: Blend,
) -> Array:
    """Multipliers (k, C) that nodes (k,), which are fitted to linear RGB (k, 3), start
    from.

    Corners of the cell of an entry start from a blend of its multipliers in ``entries``
    (E, C) with the prior, all other nodes from the prior.
    """
    multipliers = prior.at_nodes(seeds.lattice, rgb)
    _, seeded, row = np.intersect1d(
        points, seeds.points, assume_unique=True, return_indices=True
    )
    entry = seeds.entry[row]
    node_lab = rgb_to_lab(prior.sensor, rgb[seeded])
    entry_lab = rgb_to_lab(prior.sensor, seeds.rgb)
    distance = delta_e_1976(node_lab, entry_lab[entry])
    weight = blend(prior, seeds, entry, distance)
    multipliers[seeded] = blended(
        prior.model, entries[entry], multipliers[seeded], weight
    )
    return multipliers


def lattice_error(
    problem: Problem, lattice: Lattice, prior: Prior, entries: FittedEntries
) -> Array:
    """Largest ΔE00 (E,) under the lights between each entry's fitted spectrum and the
    lattice at its colour, if nodes start from the entries alone.

    Only the corners of the entries' cells are fitted. Entry boxes are not used.
    """
    seeds = seed(lattice, entries.rgb)
    points = np.sort(seeds.points)
    target = lattice.target(points)
    start = initial_guess(
        points,
        target,
        prior,
        seeds,
        entries=entries.multipliers,
        blend=full_entry,
    )
    fitted = problem.solve(target, start, MAX_PASSES, prior=start).multipliers
    wavelengths = problem.sensor.wavelengths
    spectra = evaluate(problem.model, fitted, wavelengths)
    goals = evaluate(problem.model, entries.multipliers, wavelengths)
    # What the interpolation of the lattice answers at the colours of the entries
    corners, weights = lattice.corners(entries.rgb)
    answers = weighted_sum(spectra, np.searchsorted(points, corners), weights)
    errors = [delta_e_spectra(light, answers, goals) for light in problem.lights]
    return np.max(errors, axis=0)


def choose_lattice(
    problem: Problem, prior: Prior, entries: FittedEntries, max_error: float
) -> tuple[str, int, int]:
    """Choose the smallest lattice that keeps every entry within ``max_error`` or, if
    none does, keeps the most.

    Returns the spacing of its axis nodes, its dim, and the number of entries that it
    does not keep.
    """
    trials = []
    for dim in DIMS:
        for axis in AXES:
            lattice = Lattice(axis_nodes(axis, dim))
            errors = lattice_error(problem, lattice, prior, entries)
            trials.append((int((errors > max_error).sum()), dim, axis))
        lost, dim, axis = min(trials, key=lambda trial: trial[:2])
        if not lost:
            break
    return axis, dim, lost
