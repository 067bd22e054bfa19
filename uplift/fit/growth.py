"""State of growth, the second attempt at failed nodes, and the improvement pass
(docs/mathematics.md, 7).

Nodes are fitted in rounds, in one of three orders (docs/accuracy.md):

- `uplift.fit.growth_outward`, the default: outward from the seeds, in shells.
- `uplift.extras.thesis.growth_coarse`: from a coarse lattice to finer ones.
- `uplift.extras.thesis.growth_neighbours`: outward, each node from a fitted neighbour,
  as Tódová 2020 does.

In the first two the answer at a node is the spectrum of its colour that is nearest to
its prior. The correction between prior and answer is smooth over the lattice, so a node
starts from its prior plus the correction expected from earlier rounds. Most nodes then
need one step in place of two, and the answer does not depend on the start. Nodes that
fail are tried again from the mean of their fitted neighbours (`retry`).

After any of them the improvement pass (`improve`; Tódová 2020, "Constrained spectral
uplifting", section 3.1.4) moves nodes over the threshold out of local minima.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices, Mask, blocks, largest
from uplift.common.progress import Progress, ProgressCallback
from uplift.fit.problem import Nodes, Problem
from uplift.fit.solver import Solution
from uplift.lattice.point_table import NOT_FITTED
from uplift.models.arithmetic import blocked_matmul

MAX_PASSES = 24
IMPROVEMENT_PASSES = 192
BLOCK_POINTS = 1 << 15
"""Nodes processed at a time."""
MAX_CORRECTION = 0.1
"""Largest correction, in units of the metric, that others start from: nearly box-shaped
spectra have larger ones, which are not smooth.
"""
NUDGE = 0.5
"""Change of a multiplier in the improvement pass."""
EXTREME = 100.0
"""Linear part of a nearly white (+) or nearly black (−) spectrum."""
STEPS = (
    "more iterations",
    "from grey",
    "constant multiplier nudged",
    "all multipliers nudged",
    "from white or black",
)
"""More iterations fix nearly every realisable node, grey those whose neighbours were
black or white, where the gradient vanishes. The steps of the thesis, which moves Ceres
out of minima in moment space, remain for the rest.
"""
THESIS_STEPS = (
    "constant multiplier nudged",
    "all multipliers nudged",
    "more iterations",
    "from white or black",
    "from white or black, constant multiplier nudged",
    "from white or black, all multipliers nudged",
)
"""The order of Tódová 2020, section 3.1.4."""
Expected = Callable[[Indices, Array], Array]
"""From nodes (k,) and the linear RGB (k, 3) that they are fitted to, to the multipliers
(k, C) expected there.
"""


class Growth:
    """State of growth over all n nodes of a lattice, changed in place round by round.

    ``multipliers`` (n, C) are the best so far, ``distance`` (n,) their distance from
    the goal and ``rgb`` (n, 3) their linear RGB; 0, infinite and 0 at nodes that are
    not to be fitted. ``round`` (n,) is that in which the node was fitted, −1 if none
    did or the improvement pass did, and ``done`` counts the nodes that rounds fitted.
    """

    def __init__(
        self, problem: Problem, nodes: Nodes, progress: ProgressCallback
    ) -> None:
        self.problem = problem
        self.nodes = nodes
        self.progress = progress
        size = nodes.lattice.size
        self.multipliers = np.zeros((size, problem.model.count))
        self.distance = np.full(size, np.inf)
        self.rgb = np.zeros((size, 3), dtype=np.float32)
        self.round = np.full(size, NOT_FITTED, dtype=np.int16)
        self.done = 0

    def waiting_blocks(self) -> list[Indices]:
        """Nodes that are not fitted, ascending, in blocks."""
        points = self.nodes.points
        points = points[self.round[points] == NOT_FITTED]
        return [points[block] for block in blocks(len(points), BLOCK_POINTS)]

    def attempt(
        self,
        points: Indices,
        start: Array,
        number: int | NDArray[np.signedinteger],
        prior: Array | None = None,
        max_passes: int = MAX_PASSES,
    ) -> Solution:
        """Solve nodes (k,) from multipliers (k, C) and keep results that are nearer to
        the goal than before.

        ``number`` is their round, or `NOT_FITTED` in the improvement pass.
        """
        goal = self.nodes.goal(points)
        solution = self.problem.solve(goal, start, max_passes, prior)
        better = solution.distance < self.distance[points]
        kept = points[better]
        self.multipliers[kept] = solution.multipliers[better]
        self.distance[kept] = solution.distance[better]
        self.rgb[kept] = (goal - solution.residual)[better]
        fitted = (self.round[points] == NOT_FITTED) & (
            solution.distance <= self.problem.threshold
        )
        numbers = np.broadcast_to(number, points.shape)
        self.round[points[fitted]] = numbers[fitted]
        last = int(numbers.max(initial=NOT_FITTED))
        if last != NOT_FITTED:
            self.done += int(fitted.sum())
            detail = f"round {last}: {len(points)} tried"
            total = len(self.nodes.points)
            self.progress(Progress("fit", self.done, total, step=last, detail=detail))
        return solution

    def is_smooth(self, correction: Array) -> Mask:
        """Whether corrections (k, C) are small enough to expect similar ones nearby:
        |R⁻¹ (p − p₀)|∞. They all are where the colour determines them.
        """
        if self.problem.model.is_determined:
            return np.ones(len(correction), dtype=bool)
        root = self.problem.forward.inverse_root
        change = blocked_matmul(correction, root.T)
        return largest(np.abs(change)) <= MAX_CORRECTION


def retry(growth: Growth, number: int) -> None:
    """Try failed nodes again from the mean of their fitted neighbours, while one more
    of these has been fitted.
    """
    lattice = growth.nodes.lattice
    multipliers = growth.multipliers
    fresh = np.flatnonzero(growth.round != NOT_FITTED)
    while fresh.size:
        fitted = growth.round != NOT_FITTED
        is_fresh = lattice.mask(fresh)
        points = [fresh[:0]]
        means = [multipliers[:0]]
        for block in growth.waiting_blocks():
            neighbours, inside = lattice.neighbours(block)
            adjacent = (inside & is_fresh[neighbours]).any(axis=1)
            neighbours = neighbours[adjacent]
            known = inside[adjacent] & fitted[neighbours]
            # Column by column: all 26 neighbours at once would take 26 times the
            # memory.
            total = np.zeros((len(neighbours), multipliers.shape[1]))
            for near, is_known in zip(neighbours.T, known.T, strict=True):
                total += np.where(is_known[:, None], multipliers[near], 0)
            points.append(block[adjacent])
            means.append(total / np.maximum(known.sum(axis=1), 1)[:, None])
        tried = np.concatenate(points)
        if not tried.size:
            break
        solution = growth.attempt(tried, np.concatenate(means), number)
        fresh = tried[solution.distance <= growth.problem.threshold]
        number += 1


def improve(growth: Growth, steps: Sequence[str] = STEPS) -> list[tuple[str, int, int]]:
    """Improve nodes in place. Each step tries those that are still over the threshold;
    no distance increases.

    Returns each step with the numbers of nodes that it tried, and of those that are
    within the threshold afterwards.
    """
    problem = growth.problem
    points = growth.nodes.points
    done = []
    # Alternating nudges, the same for every node and every run: no direction is better
    # justified than another.
    alternating = NUDGE * (-1.0) ** np.arange(problem.model.count)
    for step in steps:
        points = points[growth.distance[points] > problem.threshold]
        if not points.size:
            break
        # A linear part of +1 for goals nearer to white, −1 for those nearer to black,
        # at all wavelengths.
        sign = np.where(growth.nodes.goal(points).mean(axis=1) >= 0.5, 1.0, -1.0)
        best = growth.multipliers[points]
        extreme = sign[:, None] * problem.model.constant()
        start = {
            "more iterations": best,
            "from grey": np.zeros_like(best),
            "constant multiplier nudged": best + NUDGE * extreme,
            "all multipliers nudged": best + alternating,
            "from white or black": EXTREME * extreme,
            "from white or black, constant multiplier nudged": (EXTREME - NUDGE)
            * extreme,
            "from white or black, all multipliers nudged": EXTREME * extreme
            + alternating,
        }[step]
        growth.attempt(points, start, NOT_FITTED, max_passes=IMPROVEMENT_PASSES)
        fixed = int((growth.distance[points] <= problem.threshold).sum())
        done.append((step, len(points), fixed))
    return done
