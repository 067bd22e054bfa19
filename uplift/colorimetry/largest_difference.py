"""The largest colour difference between the metamers of a mismatch volume and given ones.

ΔE00 is not convex, so the search starts in 20 parts of the volume: the triangles of directions within each triangle of
the icosahedron. The metamer of a start is the extreme in the direction in which ΔE00 rises fastest at the outer corner
that is most different. Each step goes to the extreme in the direction in which ΔE00 rises fastest at the current one,
and the search ends where that is no more different.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab, lab_jacobian
from uplift.colorimetry.extreme_spectra import extreme_spectra
from uplift.colorimetry.mismatch import MismatchVolumes
from uplift.common.arrays import Array

PARTS = 20
"""Triangles of the icosahedron; a triangle of a divided one belongs to that of its number modulo this."""
MAX_STEPS = 20
DIFFERENCE_STEP = 1e-3
"""Step in L*a*b* of the differences that approximate the derivative of ΔE00."""
MIN_RISE = 1e-9
"""Rise of ΔE00 below which the search ends."""


@dataclass(frozen=True, eq=False)
class LargestDifference:
    """The metamers that differ most from given ones, n of them.

    Parameters
    ----------
    delta_e_2000 : ndarray, shape (n,)
        ΔE00 of the most different metamer that was found.
    outer : ndarray, shape (n,)
        Largest ΔE00 to a corner of the polyhedron around the volume, at least ``delta_e_2000``. A difference that
        grows along all straight lines from the given colour would be bounded by it; ΔE00 nearly does.
    xyz : ndarray, shape (n, 3)
        XYZ of the most different metamers.
    """

    delta_e_2000: Array
    outer: Array
    xyz: Array


def largest_difference(volumes: MismatchVolumes, xyz: Array) -> LargestDifference:
    """Find the metamers that differ most from given ones.

    Parameters
    ----------
    volumes : MismatchVolumes
        The volumes of n colours.
    xyz : ndarray, shape (n, 3)
        XYZ of reflectances of these colours under the light.

    Returns
    -------
    LargestDifference
    """
    white = volumes.light.white
    reference = lab(xyz, white)
    sampled = delta_e_2000(volumes.lab, reference[:, None])
    corners = volumes.corners
    outer = delta_e_2000(lab(corners, white), reference[:, None])
    faces = outer.reshape(len(outer), -1, PARTS).argmax(axis=1) * PARTS + np.arange(PARTS)
    row, faces = np.repeat(np.arange(len(xyz)), PARTS), faces.ravel()
    basis = volumes.basis[row, volumes.directions.faces[faces, 0]]
    search = _Search(volumes, reference)
    found, points = search.ascend(row, search.slope(row, corners[row, faces]), basis)
    values = np.concatenate([sampled, found.reshape(-1, PARTS)], axis=1)
    points = np.concatenate([volumes.xyz, points.reshape(-1, PARTS, 3)], axis=1)
    best = values.argmax(axis=1)[:, None]
    largest = np.take_along_axis(values, best, axis=1)[:, 0]
    return LargestDifference(
        largest,
        np.maximum(outer.max(axis=1), largest),
        np.take_along_axis(points, best[:, :, None], axis=1)[:, 0],
    )


@dataclass(frozen=True, eq=False)
class _Search:
    volumes: MismatchVolumes
    reference: Array
    """(n, 3) L*a*b* of the given metamers."""

    def ascend(self, row: Array, slope: Array, basis: Array) -> tuple[Array, Array]:
        """ΔE00 (m,) and XYZ (m, 3) where the steps from the extremes in the directions (m, 3) end."""
        found, points = np.zeros(len(row)), np.zeros((len(row), 3))
        rises = np.arange(len(row))
        for _ in range(MAX_STEPS):
            extreme = extreme_spectra(
                self.volumes.sensor.matrix,
                self.volumes.rgb[row[rises]],
                slope @ self.volumes.light.xyz,
                basis[rises],
            )
            trial = extreme.reflectance @ self.volumes.light.xyz.T
            value = delta_e_2000(self._lab(trial), self.reference[row[rises]])
            better = value > found[rises] + MIN_RISE
            rises, trial = rises[better], trial[better]
            if not len(rises):
                break
            found[rises], points[rises], basis[rises] = value[better], trial, extreme.basis[better]
            slope = self.slope(row[rises], trial)
        return found, points

    def slope(self, row: Array, xyz: Array) -> Array:
        """Derivative (m, 3) of ΔE00 with respect to XYZ (m, 3)."""
        at, steps = self._lab(xyz)[:, None], DIFFERENCE_STEP * np.eye(3)
        reference = self.reference[row, None]
        rise = delta_e_2000(at + steps, reference) - delta_e_2000(at - steps, reference)
        jacobian = lab_jacobian(xyz, self.volumes.light.white)
        return np.asarray((rise[:, None, :] @ jacobian)[:, 0] / (2 * DIFFERENCE_STEP))

    def _lab(self, xyz: Array) -> Array:
        return lab(xyz, self.volumes.light.white)
