"""The largest colour difference between the metamers of a mismatch volume and given ones.

ΔE00 is not convex, so the search starts in 20 parts of the volume: the triangles of directions within each triangle of
the icosahedron. The metamer of a start is the extreme in the direction in which ΔE00 rises fastest at the outer corner
that is most different. Each step goes to the extreme in the direction in which ΔE00 rises fastest at the current one,
and ends where the new metamer differs no more. Finally, directions close to that of the best metamer are tried.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab, lab_jacobian
from uplift.colorimetry.extreme_spectra import extreme_spectra
from uplift.colorimetry.mismatch import MismatchVolumes
from uplift.colorimetry.sphere import sphere
from uplift.common.arrays import Array, Indices

PARTS = 20
"""Triangles of the icosahedron; a triangle of a divided one belongs to that of its number modulo this."""
MAX_STEPS = 20
DIFFERENCE_STEP = 1e-3
"""Step in L*a*b* of the differences that approximate the derivative of ΔE00."""
REFINEMENTS = 3
RING = np.concatenate([size * sphere(0).directions for size in (0.4, 0.15, 0.05)])
"""Changes of a direction of length 1 that are tried around the most different metamer."""
MIN_RISE = 1e-9
"""Rise of ΔE00 below which the search ends."""


@dataclass(frozen=True, eq=False)
class LargestDifference:
    """The metamers that differ most from given ones, n of them."""

    delta_e_2000: Array
    """(n,) ΔE00 of the most different metamer that was found."""
    outer: Array
    """(n,) Largest ΔE00 to a corner of the polyhedron around the volume, at least ``delta_e_2000``. A difference
    that grows along all straight lines from the given colour would be bounded by it; ΔE00 nearly does."""
    xyz: Array
    """(n, 3) XYZ of the most different metamers."""


def largest_difference(volumes: MismatchVolumes, xyz: Array) -> LargestDifference:
    """Find the metamers that differ most from given ones. Shapes: ``xyz`` (n, 3)."""
    white = volumes.light.white
    reference = lab(xyz, white)
    sampled = delta_e_2000(volumes.lab, reference[:, None])
    corners = volumes.corners
    outer = delta_e_2000(lab(corners, white), reference[:, None])
    faces = outer.reshape(len(outer), -1, PARTS).argmax(axis=1) * PARTS + np.arange(PARTS)
    row, faces = np.repeat(np.arange(len(xyz)), PARTS), faces.ravel()
    basis = volumes.basis[row, volumes.directions.faces[faces, 0]]
    search = _Search(volumes, reference)
    slope = search.slope(row, corners[row, faces])
    found = search.ascend(row, slope, basis)
    best = _Metamers(
        np.concatenate([sampled, found.delta_e.reshape(-1, PARTS)], axis=1),
        np.concatenate([volumes.xyz, found.xyz.reshape(-1, PARTS, 3)], axis=1),
        np.concatenate(
            [np.broadcast_to(volumes.normals, volumes.xyz.shape), found.direction.reshape(-1, PARTS, 3)], axis=1
        ),
        np.concatenate([volumes.basis, found.basis.reshape(-1, PARTS, 3)], axis=1),
    ).best()
    for _ in range(REFINEMENTS):
        best = search.around(best)
    return LargestDifference(best.delta_e, np.maximum(outer.max(axis=1), best.delta_e), best.xyz)


class _Metamers(NamedTuple):
    delta_e: Array
    """(..., )"""
    xyz: Array
    """(..., 3)"""
    direction: Array
    """(..., 3) of XYZ, in which the metamer is the extreme."""
    basis: Indices
    """(..., 3)"""

    def best(self) -> _Metamers:
        """Of (n, k) metamers the (n,) most different ones."""
        rows = np.arange(len(self.delta_e))
        return _Metamers(*(each[rows, self.delta_e.argmax(axis=1)] for each in self))


@dataclass(frozen=True, eq=False)
class _Search:
    volumes: MismatchVolumes
    reference: Array
    """(n, 3) L*a*b* of the given metamers."""

    def extremes(self, row: Indices, direction: Array, basis: Indices) -> _Metamers:
        """Metamers (m,) of colours (m,) in directions (m, 3) of XYZ."""
        light = self.volumes.light
        extreme = extreme_spectra(self.volumes.sensor.matrix, self.volumes.rgb[row], direction @ light.xyz, basis)
        xyz = extreme.reflectance @ light.xyz.T
        return _Metamers(delta_e_2000(self._lab(xyz), self.reference[row]), xyz, direction, extreme.basis)

    def ascend(self, row: Indices, slope: Array, basis: Indices) -> _Metamers:
        """Metamers (m,) where the steps from the extremes in the directions (m, 3) end."""
        found = self.extremes(row, slope, basis)
        rises = np.arange(len(row))
        for _ in range(MAX_STEPS):
            trial = self.extremes(row[rises], self.slope(row[rises], found.xyz[rises]), found.basis[rises])
            better = trial.delta_e > found.delta_e[rises] + MIN_RISE
            rises = rises[better]
            if not len(rises):
                break
            for each, new in zip(found, trial, strict=True):
                each[rises] = new[better]
        return found

    def around(self, best: _Metamers) -> _Metamers:
        """The most different of metamers (n,) and of those in directions around theirs."""
        count = len(best.delta_e)
        scale = self.volumes.scale
        middle = best.direction @ scale
        middle /= np.linalg.norm(middle, axis=1)[:, None]
        directions = (middle[:, None] + RING) @ np.linalg.inv(scale)
        row = np.repeat(np.arange(count), len(RING))
        ring = self.extremes(row, directions.reshape(-1, 3), np.repeat(best.basis, len(RING), axis=0))
        return _Metamers(
            *(
                np.concatenate([old[:, None], new.reshape(count, len(RING), *new.shape[1:])], axis=1)
                for old, new in zip(best, ring, strict=True)
            )
        ).best()

    def slope(self, row: Indices, xyz: Array) -> Array:
        """Derivative (m, 3) of ΔE00 with respect to XYZ (m, 3)."""
        at, steps = self._lab(xyz)[:, None], DIFFERENCE_STEP * np.eye(3)
        reference = self.reference[row, None]
        rise = delta_e_2000(at + steps, reference) - delta_e_2000(at - steps, reference)
        jacobian = lab_jacobian(xyz, self.volumes.light.white)
        return np.asarray((rise[:, None, :] @ jacobian)[:, 0] / (2 * DIFFERENCE_STEP))

    def _lab(self, xyz: Array) -> Array:
        return lab(xyz, self.volumes.light.white)
