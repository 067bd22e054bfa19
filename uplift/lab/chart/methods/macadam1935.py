"""Spectra of one step up and one down: MacAdam 1935, The theory of the maximum visual efficiency of colored materials.

Of all reflectances of a chromaticity a box from 0 to 1, that of a passed band or of a stopped one, is the brightest.
One of the same edges and less height has any darker colour. A baseline: no measurement looks so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, nbytes, stopwatch
from uplift.lab.chart.task import Task

STEPS, HALVINGS = 6, 4
"""Of Newton's method, and of a step that does not help; most edges settle in three."""
STARTS = 16
"""Boxes to start from; few colours need more than one."""
CLOSE = 1e-7
"""CIE xy."""
DARK = 1e-12
"""Luminance that has no chromaticity."""


@dataclass(frozen=True, eq=False)
class Boxes:
    """Boxes that rise at one place and fall at a later one, counted in samples of a sensor.

    Wavelengths go round: a box that runs past the last sample goes on with the first, and is a stopped band.
    ``weights`` (N, 3) are XYZ of a sample, ``below`` (N, 3) their sums up to it. ``starts`` (S, 2) are whole boxes, and
    ``tree`` holds their chromaticities.
    """

    sensor: Sensor
    weights: Array
    below: Array
    starts: Array
    tree: cKDTree

    def xyz(self, edges: Array) -> Array:
        """XYZ (n, 3) of full boxes with ``edges`` (n, 2)."""
        return _xyz(self.weights, self.below, edges)

    def find(self, xy: Array) -> Array:
        """Edges (n, 2) of the boxes of chromaticities (n, 2): of the nearest whole ones, one after the other."""
        found = self.starts[self.tree.query(xy)[1]]
        off = self._off(found, xy)
        for start in range(STARTS):
            rows = np.flatnonzero(off > CLOSE)
            if not rows.size:
                break
            near = self.starts[self.tree.query(xy[rows], [start + 1])[1][:, 0]]
            edges = self._descend(near, xy[rows])
            off_edges = self._off(edges, xy[rows])
            better = off_edges < off[rows]
            found[rows[better]], off[rows[better]] = edges[better], off_edges[better]
        return found

    def _descend(self, edges: Array, xy: Array) -> Array:
        """By Newton's method, in steps that are halved until they help."""
        for _ in range(STEPS):
            step, off = self._step(edges, xy), self._off(edges, xy)
            for _ in range(HALVINGS):
                there = edges + step
                length = there[:, 1] - there[:, 0]
                better = (length > 0) & (length <= len(self.weights)) & (self._off(there, xy) < off)
                edges[better] = there[better]
                step[better] = 0
                step /= 2
        return edges

    def _off(self, edges: Array, xy: Array) -> Array:
        return np.asarray(np.linalg.norm(chromaticity(self.xyz(edges)) - xy, axis=1))

    def _step(self, edges: Array, xy: Array) -> Array:
        here = self.xyz(edges)
        total, now = here.sum(axis=1)[:, None, None], chromaticity(here)
        slope = self.weights[np.floor(edges).astype(int) % len(self.weights)] * [[-1], [1]]
        jacobian = ((slope[..., :2] - now[:, None] * slope.sum(axis=-1, keepdims=True)) / total).swapaxes(
            1, 2
        )
        return np.asarray((np.linalg.pinv(jacobian) @ (xy - now)[..., None])[..., 0])

    def __call__(self, rgb: Array, wavelengths: Array) -> Array:
        wanted, count = self.sensor.xyz(rgb), len(self.weights)
        dark = wanted[:, 1] < DARK
        wanted[dark] = self.sensor.light.white
        edges = self.find(chromaticity(wanted))
        height = np.where(dark, 0, np.minimum(wanted[:, 1] / self.xyz(edges)[:, 1], 1))
        start, step = self.sensor.wavelengths[0], self.sensor.wavelengths[1] - self.sensor.wavelengths[0]
        place = np.clip((wavelengths - start) / step, 0, count - 1)
        first = np.floor(edges[:, :1] / count) * count
        inside = [
            np.clip(np.minimum(edges[:, 1:] - turn, place + 1) - np.maximum(edges[:, :1] - turn, place), 0, 1)
            for turn in (first, first + count)
        ]
        return np.asarray(height[:, None] * (inside[0] + inside[1]))


def _xyz(weights: Array, below: Array, edges: Array) -> Array:
    turns, place = np.divmod(edges, len(weights))
    low = place.astype(int)
    total = below[-1] + weights[-1]
    rise, fall = np.moveaxis(
        turns[..., None] * total + below[low] + (place - low)[..., None] * weights[low], 1, 0
    )
    return np.asarray(fall - rise)


def chromaticity(xyz: Array) -> Array:
    """CIE xy (n, 2) of XYZ (n, 3)."""
    return xyz[:, :2] / xyz.sum(axis=1, keepdims=True)


def boxes(sensor: Sensor) -> Boxes:
    """All that is needed to find the box of a colour."""
    weights = np.ascontiguousarray(sensor.light.xyz.T)
    below = weights.cumsum(axis=0) - weights
    rise, length = np.divmod(np.arange(len(weights) ** 2), len(weights))
    starts = np.stack([rise, rise + length + 1], axis=1).astype(float)
    return Boxes(sensor, weights, below, starts, cKDTree(chromaticity(_xyz(weights, below, starts))))


def prepare(task: Task) -> PreparedMethod:
    made, seconds = stopwatch(lambda: boxes(task.sensor))
    return PreparedMethod(made, nbytes((made.weights, made.below, made.starts, made.tree.data)), seconds)


FAMILIES = (
    Family(
        "MacAdam 1935",
        "MacAdam, The theory of the maximum visual efficiency of colored materials, JOSA 25, 1935",
        "#7d7d7d",
        (
            Method(
                "macadam1935",
                "MacAdam 1935",
                prepare,
                Claims(round_trip=0.01),
                quick=True,
                note="box spectra, our own baseline",
            ),
        ),
    ),
)
