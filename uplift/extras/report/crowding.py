"""Entries of a cube that are close to others, or share the colour of another."""

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.cube.data import CubeData
from uplift.extras.report.entries import EntryErrors

# lattice steps; two entries of one cell are never farther apart
MAX_DISTANCE = 1 + 1e-9


@dataclass(frozen=True, eq=False)
class Crowding:
    """Entries of a cube that have another one within a lattice step, largest error of
    the lattice first.
    """

    entries: EntryErrors  # Errors of the k close entries
    nearest: tuple[str, ...]  # Name of the nearest other entry, for each of the k
    # (k,) Lattice steps to the nearest other entry, along the axis on which they differ
    # most
    distances: Array
    # Entries that no colour returns because another one has the same colour, and the
    # name of the other
    lost: tuple[tuple[str, str], ...]


def find_crowding(data: CubeData, errors: EntryErrors) -> Crowding:
    """Find the entries that have another one within a lattice step."""
    names = data.atlas.names
    nearest, distances = _nearest(data.lattice.to_steps(data.atlas.rgb))
    row_of = {name: row for row, name in enumerate(names)}
    errors = errors.take(
        [row for row, name in enumerate(errors.names) if name in row_of]
    )
    assert errors.lattice is not None
    errors = errors.take(errors.lattice.worst_rows(len(errors.names)))
    rows = np.array([row_of[name] for name in errors.names], dtype=np.int64)
    close = distances[rows] <= MAX_DISTANCE
    rows = rows[close]
    return Crowding(
        errors.take(np.flatnonzero(close)),
        tuple(names[other] for other in nearest[rows]),
        distances[rows],
        _lost(data),
    )


def _nearest(steps: Array) -> tuple[Indices, Array]:
    """Index of the nearest other row of ``steps`` (n, 3), and its maximum-norm
    distance, infinite for n < 2.
    """
    from scipy.spatial import KDTree

    if len(steps) < 2:
        return np.zeros(len(steps), dtype=np.int64), np.full(len(steps), np.inf)
    distances, rows = KDTree(steps).query(steps, k=2, p=np.inf)
    # The first of the two is the row itself, unless another has the same colour.
    is_itself = rows[:, 0] == np.arange(len(steps))
    return np.where(is_itself, rows[:, 1], rows[:, 0]), distances[:, 1]


def _lost(data: CubeData) -> tuple[tuple[str, str], ...]:
    names = data.atlas.names
    rows = np.flatnonzero(data.atlas.half_width == 0)
    hits = data.entry_boxes.find(data.atlas.rgb[rows])
    return tuple(
        (names[rows[row]], names[other])
        for row, other in zip(hits.rows, hits.entry, strict=True)
    )
