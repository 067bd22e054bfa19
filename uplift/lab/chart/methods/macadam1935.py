"""Box spectra: optimal colours scaled in height.

Of all reflectances of a chromaticity, a box function from 0 to 1, of a passed or of a stopped band, is the brightest.
A lower box with the same edges has any darker colour. A baseline: no measured spectrum is a box.

Domain: linear sRGB in [0, 1] under D65. Range: reflectance in [0, 1] at the sensor's wavelengths.

References
----------
MacAdam 1935, "The theory of the maximum visual efficiency of colored materials", JOSA 25.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, Task, nbytes, ours, stopwatch

STEPS, HALVINGS = 6, 4
"""Steps of Newton's method, and halvings of a step that does not reduce the error; most edges converge in three."""
STARTS = 16
"""Boxes to start from, one after the other; few colours need more than one."""
TOLERANCE = 1e-7
"""CIE xy."""
DARK = 1e-12
"""Luminance below which a colour is black."""


@dataclass(frozen=True, eq=False)
class Boxes:
    """Box functions by their rising and falling edges, in units of the sensor's samples.

    Wavelengths are cyclic: a box that extends beyond the last sample continues at the first, and is a stopped band.

    ``sensor``: the sensor.
    ``weights`` (N, 3): XYZ of each sample.
    ``below`` (N, 3): sums of the weights of all samples before.
    ``starts`` (S, 2): edges of the boxes that begin and end between samples.
    ``tree``: their chromaticities.
    """

    sensor: Sensor
    weights: Array
    below: Array
    starts: Array
    tree: cKDTree

    def xyz(self, edges: Array) -> Array:
        """XYZ (n, 3) of boxes of height 1 with ``edges`` (n, 2)."""
        return _xyz(self.weights, self.below, edges)

    def find(self, xy: Array) -> Array:
        """Edges (n, 2) of the boxes of chromaticities (n, 2), starting from the nearest known ones in turn."""
        edges = self.starts[self.tree.query(xy)[1]]
        error = self._error(edges, xy)
        for start in range(STARTS):
            rows = np.flatnonzero(error > TOLERANCE)
            if not rows.size:
                break
            near = self.starts[self.tree.query(xy[rows], [start + 1])[1][:, 0]]
            improved = self._descend(near, xy[rows])
            improved_error = self._error(improved, xy[rows])
            better = improved_error < error[rows]
            edges[rows[better]], error[rows[better]] = improved[better], improved_error[better]
        return edges

    def _descend(self, edges: Array, xy: Array) -> Array:
        """Newton's method with steps that are halved until they reduce the error."""
        for _ in range(STEPS):
            step, error = self._step(edges, xy), self._error(edges, xy)
            for _ in range(HALVINGS):
                new = edges + step
                length = new[:, 1] - new[:, 0]
                better = (length > 0) & (length <= len(self.weights)) & (self._error(new, xy) < error)
                edges[better] = new[better]
                step[better] = 0
                step /= 2
        return edges

    def _error(self, edges: Array, xy: Array) -> Array:
        return np.asarray(np.linalg.norm(chromaticity(self.xyz(edges)) - xy, axis=1))

    def _step(self, edges: Array, xy: Array) -> Array:
        xyz = self.xyz(edges)
        total, current = xyz.sum(axis=1)[:, None, None], chromaticity(xyz)
        slope = self.weights[np.floor(edges).astype(int) % len(self.weights)] * [[-1], [1]]
        jacobian = ((slope[..., :2] - current[:, None] * slope.sum(axis=-1, keepdims=True)) / total).swapaxes(1, 2)
        return np.asarray((np.linalg.pinv(jacobian) @ (xy - current)[..., None])[..., 0])

    def __call__(self, rgb: Array, wavelengths: Array) -> Array:
        target, count = self.sensor.xyz(rgb), len(self.weights)
        dark = target[:, 1] < DARK
        target[dark] = self.sensor.light.white
        edges = self.find(chromaticity(target))
        height = np.where(dark, 0, np.minimum(target[:, 1] / self.xyz(edges)[:, 1], 1))
        start, step = self.sensor.wavelengths[0], self.sensor.wavelengths[1] - self.sensor.wavelengths[0]
        position = np.clip((wavelengths - start) / step, 0, count - 1)
        first = np.floor(edges[:, :1] / count) * count
        inside = [
            np.clip(
                np.minimum(edges[:, 1:] - turn, position + 1) - np.maximum(edges[:, :1] - turn, position),
                0,
                1,
            )
            for turn in (first, first + count)
        ]
        return np.asarray(height[:, None] * (inside[0] + inside[1]))


def _xyz(weights: Array, below: Array, edges: Array) -> Array:
    turns, position = np.divmod(edges, len(weights))
    low = position.astype(int)
    total = below[-1] + weights[-1]
    rise, fall = np.moveaxis(turns[..., None] * total + below[low] + (position - low)[..., None] * weights[low], 1, 0)
    return np.asarray(fall - rise)


def chromaticity(xyz: Array) -> Array:
    """CIE xy (n, 2) of XYZ (n, 3)."""
    return xyz[:, :2] / xyz.sum(axis=1, keepdims=True)


def boxes(sensor: Sensor) -> Boxes:
    """Precompute the boxes whose edges are between samples."""
    weights = np.ascontiguousarray(sensor.light.xyz.T)
    below = weights.cumsum(axis=0) - weights
    rise, length = np.divmod(np.arange(len(weights) ** 2), len(weights))
    starts = np.stack([rise, rise + length + 1], axis=1).astype(float)
    return Boxes(sensor, weights, below, starts, cKDTree(chromaticity(_xyz(weights, below, starts))))


def prepare(task: Task) -> PreparedMethod:
    """Prepare the boxes of the sensor."""
    table, seconds = stopwatch(lambda: boxes(task.sensor))
    return PreparedMethod(table, nbytes((table.weights, table.below, table.starts, table.tree.data)), seconds)


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
                judge=ours,
                quick=True,
                note="box spectra, a baseline of this package",
            ),
        ),
    ),
)
