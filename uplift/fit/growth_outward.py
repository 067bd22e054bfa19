"""Growth outward from the seeds, in shells, the default order.

A node starts from its prior plus the correction extrapolated from the two nodes before
it on the way to a seed.
"""

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Indices, blocks
from uplift.common.progress import ProgressCallback
from uplift.fit.growth import BLOCK_POINTS, Expected, Growth, retry
from uplift.fit.problem import Nodes, Problem
from uplift.lattice.lattice import Lattice


def grow_outward(
    problem: Problem,
    nodes: Nodes,
    expected: Expected,
    seeds: Indices,
    progress: ProgressCallback,
) -> Growth:
    """Fit nodes from the prior, in the order of their distance from the seeds (S,), or
    from the middle without any.

    Seeds start from entries, or half-way between entry and prior, and give and take no
    correction.
    """
    growth = Growth(problem, nodes, progress)
    lattice = nodes.lattice
    middle = lattice.index(np.full((1, 3), lattice.dim // 2))
    distance, toward = shells(lattice, seeds if seeds.size else middle)
    # δ = p − p₀ of the nodes, in single precision as it is only a start, and whether it
    # is known and smooth
    corrections = np.zeros((lattice.size, problem.model.count), dtype=np.float32)
    known = np.zeros(lattice.size, dtype=bool)
    seeded = lattice.mask(seeds)
    order = nodes.points[np.argsort(distance[nodes.points], kind="stable")]
    ends = np.searchsorted(distance[order], np.arange(1, distance.max() + 2))

    unsolved = [(order[:0], growth.multipliers[:0], growth.multipliers[:0])]
    for number, shell in enumerate(np.split(order, ends[:-1])):
        for block in blocks(len(shell), BLOCK_POINTS):
            points = shell[block]
            prior = expected(points, nodes.goal(points))
            # δ ≈ 2 δ₁ − δ₂ with the corrections one and two steps towards a seed, δ₁
            # where δ₂ is not known, or else 0.
            near = toward[points]
            far = toward[toward[points]]
            near_known = known[near] & (distance[near] < number)
            both_known = near_known & known[far] & (distance[far] < distance[near])
            factor = np.add(near_known, both_known, dtype=np.float32)[:, None]
            change = factor * corrections.take(near, axis=0)
            change -= both_known[:, None] * corrections.take(far, axis=0)
            start = prior + change
            solution = growth.attempt(points, start, number, prior, max_passes=1)
            correction = solution.multipliers - prior
            corrections[points] = correction
            known[points] = growth.is_smooth(correction) & ~seeded[points]
            left = solution.distance > problem.tolerance
            unsolved.append((points[left], solution.multipliers[left], prior[left]))
    # What one step leaves is fitted at the end, all at once.
    points, start, prior = (
        np.concatenate(parts) for parts in zip(*unsolved, strict=True)
    )
    growth.attempt(points, start, distance[points], prior)
    retry(growth, len(ends))
    return growth


def shells(
    lattice: Lattice, seeds: Indices
) -> tuple[NDArray[np.int16], NDArray[np.int32]]:
    """Distances (n,) of nodes from the nearest seed, in steps to any of 26 neighbours,
    and nodes (n,) nearer to a seed.

    The latter are one step along each axis towards the seed that is nearest by the sum
    of the steps along the axes.
    """
    dim = lattice.dim
    reached = lattice.mask(seeds).reshape(lattice.shape)
    steps = np.where(reached, 0, 3 * dim).astype(np.int32)
    distance = np.zeros(lattice.shape, dtype=np.int16)
    # A cube around the seeds grows by a step along each axis, one axis after another.
    while not reached.all():
        distance += ~reached
        for axis in range(3):
            old = np.moveaxis(reached, axis, 0)
            grown = np.moveaxis(reached.copy(), axis, 0)
            grown[1:] |= old[:-1]
            grown[:-1] |= old[1:]
            reached = np.moveaxis(grown, 0, axis)
    # min_j (f_j + |i − j|) along each axis, by running minima in both directions
    ramp = np.arange(dim, dtype=np.int32)
    for axis in range(3):
        along = np.moveaxis(steps, axis, -1)
        before = np.minimum.accumulate(along - ramp, axis=-1) + ramp
        after = (
            np.minimum.accumulate((along + ramp)[..., ::-1], axis=-1)[..., ::-1] - ramp
        )
        steps = np.moveaxis(np.minimum(before, after), -1, axis)
    toward = np.arange(lattice.size, dtype=np.int32).reshape(lattice.shape)
    for axis, stride in enumerate((dim * dim, dim, 1)):
        along = np.moveaxis(steps, axis, 0)
        result = np.moveaxis(toward, axis, 0)
        down = np.zeros(along.shape, dtype=bool)
        down[1:] = along[:-1] < along[1:]
        result[1:] -= stride * down[1:]
        result[:-1] += stride * ((along[1:] < along[:-1]) & ~down[:-1])
    return distance.ravel(), toward.ravel()
