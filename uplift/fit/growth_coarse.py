"""Growth from a coarse lattice to finer ones: corrections are interpolated between nodes of earlier rounds."""

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices, Mask
from uplift.common.progress import ProgressCallback
from uplift.fit.growth import Expected, Growth, grow_in_rounds
from uplift.fit.problem import Nodes, Problem

MIN_CELLS = 4
"""Cells along each axis of the coarsest lattice, at least."""


def strides(dim: int) -> list[int]:
    """Lattice steps between the nodes of each round: powers of two down to 1."""
    return [1 << power for power in reversed(range(max((dim // MIN_CELLS).bit_length(), 1)))]


def grow_coarse_to_fine(
    problem: Problem, nodes: Nodes, expected: Expected, seeds: Indices, progress: ProgressCallback
) -> Growth:
    """Fit nodes from the prior, every stride-th one of those that no coarser round has had. Seeds (S,) come first."""
    lattice, waiting = nodes.lattice, nodes.lattice.mask(nodes.points)
    levels = [lattice.thinned(stride) for stride in strides(lattice.dim)]
    rounds: list[Indices] = []
    for _, numbers in levels:
        points = numbers if rounds else np.union1d(numbers, seeds)
        rounds.append(points[waiting[points]])
        waiting[points] = False

    def predict(number: int, points: Indices, corrections: NDArray[np.float32], known: Mask) -> Array:
        """Interpolate in the cells of the last round, where all their corners are known."""
        level, numbers = levels[max(number - 1, 0)]
        corners, weights = level.corners(lattice.target(points))
        corners = numbers[corners]
        smooth = (known[corners] | (weights == 0)).all(axis=1, keepdims=True)
        return np.where(smooth, (weights[:, None, :] @ corrections[corners])[:, 0], 0)

    return grow_in_rounds(Growth(problem, nodes, progress), expected, seeds, rounds, predict)
