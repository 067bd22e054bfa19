"""Nodes that differ too much from their neighbours: halos around entries in gradients
under other lights (docs/mathematics.md, 8).

Spectra are linear in RGB within each tetrahedron of a cell, so the steepest steps of a
code start or end at its corners.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Indices, Mask, Values, blocks
from uplift.fit.growth import Growth
from uplift.lattice.lattice import CORNERS, NEIGHBOURS, Lattice, corner_room
from uplift.models.model import evaluate

LARGEST_EXCESS = 1.0
"""ΔE00 by which a light's step of an 8-bit code may exceed that under the light of the
build.
"""
REACH = 14
"""Codes from an entry within which cells keep the law."""
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
"""Steps of a code: of each channel, and of grey."""
STARTS = len(DIRECTIONS) * len(CORNERS)
"""Steps of a cell: from each corner, or to it."""
SLIGHT_EXCESS = 0.6
"""The same in L*a*b* between corners, below which no step of a cell breaks the law."""
ROUNDS = 8
"""Shipped sets need up to four in sRGB."""
MAX_PASSES = 8
SLAB = 1 << 15
"""Cells whose corners are evaluated at a time."""
BLOCK = 1 << 10
"""Cells that fit the cache."""
AXIAL = np.flatnonzero(np.abs(NEIGHBOURS).sum(axis=1) == 1)
"""Columns of `NEIGHBOURS` along the axes."""


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps of an 8-bit code in cells of a lattice, as lights see them. The first light
    is that of the build.
    """

    lattice: Lattice
    sensor: Sensor
    lights: Sequence[Light]

    def colours(self, spectra: Array) -> Array:
        """XYZ (n, L, 3) of spectra (n, N), relative to the whites of the lights."""
        columns = [(light.xyz / light.white[:, None]).T for light in self.lights]
        colours = spectra @ np.concatenate(columns, axis=1)
        return colours.reshape(len(spectra), len(self.lights), 3)

    def may_exceed(self, cells: Indices, corners: Array) -> Mask:
        """Whether steps of cells (k,) may exceed the law, from the L*a*b* (3, L, 8, k)
        of their corners: the differences between corners, spread over their codes.
        """
        codes = np.diff(self._codes)[self.lattice.position(cells)]
        size = np.maximum(codes, 1).T
        sides = corners.reshape(*corners.shape[:2], 2, 2, 2, len(cells))
        steps = [np.diff(sides, axis=2 + axis) / size[axis] for axis in range(3)]
        may = np.zeros(len(cells), dtype=bool)
        for step in (*steps, sum(steps)):
            length = np.sqrt((step * step).sum(axis=0))
            excess = length[1:].max(axis=0) - length[0]
            may |= excess.max(axis=(0, 1, 2)) > SLIGHT_EXCESS
        return may

    def excess(self, cells: Indices, corners: Array) -> Array:
        """ΔE00 (k,) by which the largest step in cells (k,) exceeds that under the
        light of the build, from the colours (k, 8, L, 3) of their corners.
        """
        count = len(self.lights)
        flat = corners.reshape(len(cells), len(CORNERS), 3 * count)
        before, after = (
            (np.maximum(corner_room(ends, ends), 0) @ flat).reshape(
                len(cells), STARTS, count, 3
            )
            for ends in self._ends(self.lattice.position(cells))
        )
        white = np.ones(3)
        steps = delta_e_2000(lab(before, white), lab(after, white))
        return np.asarray((steps[..., 1:].max(axis=-1) - steps[..., 0]).max(axis=1))

    @property
    def _codes(self) -> Array:
        """Codes (dim,) of the nodes of an axis."""
        decoding = self.sensor.decoding
        return np.interp(self.lattice.nodes, decoding, np.arange(len(decoding)))

    def _ends(self, low: Indices) -> tuple[Array, Array]:
        """Ends (k, 32, 3) of the first and last steps of a code along `DIRECTIONS`, as
        fractions of cells at positions (k, 3).
        """
        decoding = self.sensor.decoding
        codes = np.arange(len(decoding))
        start = self.lattice.nodes[low]
        size = self.lattice.nodes[low + 1] - start
        second = np.interp(self._codes[low] + 1, codes, decoding)
        second_last = np.interp(self._codes[low + 1] - 1, codes, decoding)
        after = np.minimum((second - start) / size, 1)[:, None, None]
        before = np.maximum((second_last - start) / size, 0)[:, None, None]
        moving = DIRECTIONS[:, None] > 0
        begins = np.where(moving & (CORNERS > 0), before, CORNERS)
        ends = np.where(moving & (CORNERS == 0), after, CORNERS)
        shape = (len(low), STARTS, 3)
        return begins.reshape(shape), ends.reshape(shape)


def cells_near(lattice: Lattice, sensor: Sensor, rgb: Array) -> Mask:
    """Cells (dim³,) within `REACH` of entries of linear RGB (E, 3)."""
    codes = np.arange(len(sensor.decoding), dtype=float)
    centre = np.interp(rgb, sensor.decoding, codes)
    low, high = (
        lattice.cell(np.interp(centre + reach, codes, sensor.decoding))[0]
        for reach in (-REACH, REACH)
    )
    near = np.zeros(lattice.shape, dtype=bool)
    for first, last in zip(low, high + 1, strict=True):
        near[tuple(map(slice, first, last))] = True
    return near.ravel()


def nodes_around(
    lattice: Lattice, sensor: Sensor, rgb: Array, points: Indices
) -> Indices:
    """Nodes (m,) that change nodes (k,) in `soften`, and these."""
    around = lattice.mask(points)
    for _ in range(ROUNDS):
        around = lattice.corner_points(lattice.cells_around(around))
    near = lattice.corner_points(cells_near(lattice, sensor, rgb))
    near = lattice.corner_points(lattice.cells_around(near))
    return np.flatnonzero(lattice.mask(points) | (near & around))


def soften(growth: Growth, rgb: Array, lights: Sequence[Light]) -> Indices:
    """Move nodes near entries of linear RGB (E, 3) towards their neighbours until no
    light's step exceeds that of the build by more than `LARGEST_EXCESS`.

    Returns the nodes that have changed. They keep their exact colours.
    """
    lattice = growth.nodes.lattice
    sensor = growth.problem.sensor
    steps = Steps(lattice, sensor, (sensor.light, *lights))
    exact = growth.distance <= growth.problem.threshold
    exact[growth.nodes.unrealisable] = False
    near = cells_near(lattice, sensor, rgb) & lattice.complete_cells(exact)
    changed = np.zeros(lattice.size, dtype=bool)
    columns: tuple[Values, ...] = (growth.multipliers, growth.distance, growth.rgb)
    history = list[tuple[Indices, list[Values]]]()
    steep = _steep_cells(growth, steps, np.flatnonzero(near))
    for _ in range(ROUNDS):
        if not steep.size:
            break
        corners = np.unique(steep[:, None] + lattice.index(CORNERS))
        changed[corners] = True
        history.append((corners, [column[corners] for column in columns]))
        _relax(growth, corners, exact)
        around = near & lattice.cells_around(lattice.mask(corners))
        steep = _steep_cells(growth, steps, np.flatnonzero(around))
    if not steep.size:
        return np.flatnonzero(changed)
    # Where nodes have little choice, near the limits of reflectances, they stay.
    stays = _joined(lattice, changed, steep)
    for corners, before in reversed(history):
        kept = stays[corners]
        for column, values in zip(columns, before, strict=True):
            column[corners[kept]] = values[kept]
    return np.flatnonzero(changed & ~stays)


def _joined(lattice: Lattice, changed: Mask, steep: Indices) -> Mask:
    """Nodes (dim³,) of those ``changed`` that share cells with steep ones, or with
    others that do.
    """
    from scipy.ndimage import label

    cells = lattice.cells_around(changed)
    number, _ = label(cells.reshape(lattice.shape), np.ones((3, 3, 3)))
    number = number.ravel()
    joined = cells & np.isin(number, number[steep])
    return changed & lattice.corner_points(joined)


def _steep_cells(growth: Growth, steps: Steps, cells: Indices) -> Indices:
    """Those of ``cells`` (k,) that break the law."""
    lattice = steps.lattice
    problem = growth.problem
    steep = [cells[:0]]
    for slab in blocks(len(cells), SLAB):
        corners = cells[slab, None] + lattice.index(CORNERS)
        points = np.flatnonzero(lattice.mask(corners.ravel()))
        row = np.searchsorted(points, corners)
        multipliers = growth.multipliers[points]
        spectra = evaluate(problem.model, multipliers, problem.sensor.wavelengths)
        colours = steps.colours(spectra)
        observed = np.ascontiguousarray(lab(colours, np.ones(3)).T)
        may = np.zeros(len(row), dtype=bool)
        for block in blocks(len(row), BLOCK):
            some = cells[slab][block]
            may[block] = steps.may_exceed(some, observed[:, :, row[block].T])
        some = cells[slab][may]
        excess = steps.excess(some, colours[row[may]])
        steep.append(some[excess > LARGEST_EXCESS])
    return np.concatenate(steep)


def _relax(growth: Growth, points: Indices, exact: Mask) -> None:
    """Fit nodes again, from half-way to the mean of their neighbours along the axes."""
    neighbours, inside = growth.nodes.lattice.neighbours(points)
    near = neighbours[:, AXIAL]
    known = (inside[:, AXIAL] & exact[near])[..., None]
    total = np.where(known, growth.multipliers[near], 0).sum(axis=1)
    mean = total / known.sum(axis=1)
    expected = (growth.multipliers[points] + mean) / 2
    goal = growth.nodes.goal(points)
    solution = growth.problem.solve(goal, expected, MAX_PASSES, expected)
    solved = solution.distance <= growth.problem.threshold
    kept = points[solved]
    growth.multipliers[kept] = solution.multipliers[solved]
    growth.distance[kept] = solution.distance[solved]
    growth.rgb[kept] = (goal - solution.residual)[solved]
