"""Mismatch volumes: all colours that the reflectances of one RGB can have under another light.

Of all reflectances in [0, 1] with linear RGB r under the build illuminant, the XYZ under a second light fill a convex
body: the object-colour solid of the six sensors, cut at r. In each direction its boundary is the XYZ of one extreme
reflectance (`uplift.colorimetry.extreme_spectra`). The directions are spread evenly after the space is scaled so that
the responses of the second light that the sensor does not share have the same size in all directions.

References
----------
Finlayson & Morovic 2005, "Metamer sets", JOSA A 22(5). Logvinenko, Funt & Godau 2014, "Metamer mismatching", IEEE
Transactions on Image Processing 23(1).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.extreme_spectra import extreme_spectra, first_basis
from uplift.colorimetry.sensor import Light, Sensor
from uplift.colorimetry.solid import solid
from uplift.colorimetry.sphere import COUNTS, Sphere, sphere
from uplift.common.arrays import Array, Indices
from uplift.common.errors import ColourError

DIVISIONS = 2
"""Divisions of the icosahedron: 162 directions."""
MIN_SCALE = 1e-6
"""Smallest scale of a direction, relative to the light: the volume of the build illuminant is a point."""
BLOCK_PROBLEMS = 1 << 14
"""Colours times directions processed at a time."""


@dataclass(frozen=True, eq=False, repr=False)
class MismatchVolumes:
    """Mismatch volumes of n colours under a light."""

    sensor: Sensor
    """Sensor of the RGB."""
    light: Light
    """The second light."""
    rgb: Array
    """(n, 3) Linear RGB."""
    directions: Sphere
    """D directions in the scaled space, and the triangles between them."""
    scale: Array
    """(3, 3) From the scaled space to XYZ."""
    xyz: Array
    """(n, D, 3) XYZ on the boundary, the extreme of each direction."""
    basis: Indices
    """(n, D, 3) Wavelengths at which the extreme reflectances are neither 0 nor 1."""

    @cached_property
    def lab(self) -> Array:
        """L*a*b* on the boundary, shape (n, D, 3)."""
        return lab(self.xyz, self.light.white)

    @cached_property
    def volume(self) -> Array:
        """Volumes (n,) in XYZ of the meshes between the boundary points: less than those of the bodies."""
        return mesh_volume(self.xyz, self.directions.faces)

    @cached_property
    def normals(self) -> Array:
        """Unit vectors (D, 3) of XYZ, in whose directions the boundary points are the extremes."""
        found = self.directions.directions @ np.linalg.inv(self.scale)
        return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])

    @cached_property
    def corners(self) -> Array:
        """XYZ (n, F, 3) whose convex hull contains the body: where the planes of three neighbours meet."""
        faces, directions = self.directions.faces, self.directions.directions
        scaled = self.xyz @ np.linalg.inv(self.scale).T
        support = np.einsum("kdi,di->kd", scaled, directions)[:, faces]
        return np.asarray(np.einsum("fij,kfj->kfi", np.linalg.inv(directions[faces]), support) @ self.scale.T)

    def excess(self, xyz: Array) -> Array:
        """Compute by how much colours exceed the body in the direction in which they do so most.

        Shapes: ``xyz`` (n, 3) → (n,).
        """
        return np.asarray(np.einsum("kdi,di->kd", xyz[:, None] - self.xyz, self.normals).max(axis=1))


def mismatch_volumes(sensor: Sensor, light: Light, rgb: Array, divisions: int = DIVISIONS) -> MismatchVolumes:
    """Compute the mismatch volumes of colours under a light. Shapes: ``rgb`` (n, 3)."""
    _require_realisable(sensor, rgb)
    directions, scale = sphere(divisions), _scale(sensor, light)
    response = directions.directions @ np.linalg.solve(scale, light.xyz)
    xyz = np.empty((len(rgb), len(response), 3))
    basis = np.empty(xyz.shape, dtype=np.intp)
    for block in _blocks(len(rgb), len(response)):
        _solve(sensor, light, rgb[block], response, directions.parents, xyz[block], basis[block])
    return MismatchVolumes(sensor, light, rgb, directions, scale, xyz, basis)


def mesh_volume(points: Array, faces: Indices) -> Array:
    """Compute the volumes (n,) of closed triangle meshes with corners (n, D, 3) and faces (F, 3)."""
    centred = points - points.mean(axis=1, keepdims=True)
    a, b, c = (centred[:, faces[:, corner]] for corner in range(3))
    return np.asarray(np.einsum("kfi,kfi->k", a, np.cross(b, c)) / 6)


def _require_realisable(sensor: Sensor, rgb: Array) -> None:
    outside = np.flatnonzero(~solid(sensor.matrix).contains(rgb))
    if outside.size:
        values = ", ".join(f"{value:.6g}" for value in rgb[outside[0]])
        raise ColourError(
            f"no reflectance has the colour ({values}) under {sensor.illuminant}",
            code="colour-unrealisable",
            hint="give a colour with less chroma",
        )


def _scale(sensor: Sensor, light: Light) -> Array:
    """Square root of the products of the responses of the light that those of the sensor do not explain."""
    explained = np.linalg.lstsq(sensor.matrix.T, light.xyz.T, rcond=None)[0]
    rest = light.xyz - explained.T @ sensor.matrix
    squares, axes = np.linalg.eigh(rest @ rest.T)
    lengths = np.sqrt(np.maximum(squares, MIN_SCALE**2 * (light.xyz**2).sum()))
    return np.asarray((axes * lengths) @ axes.T)


def _blocks(count: int, directions: int) -> Iterator[slice]:
    rows = max(BLOCK_PROBLEMS // directions, 1)
    return (slice(first, first + rows) for first in range(0, count, rows))


def _solve(
    sensor: Sensor, light: Light, rgb: Array, response: Array, parents: Indices, xyz: Array, basis: Indices
) -> None:
    """Fill the boundary points (n, D, 3), from coarse to fine: each direction starts at its parent's optimum."""
    basis[:] = first_basis(sensor.matrix)
    for first, last in pairwise((0, *COUNTS)):
        if first >= len(parents):
            break
        start = basis[:, parents[first:last]] if first else basis[:, :last]
        found = extreme_spectra(
            sensor.matrix,
            np.repeat(rgb, last - first, axis=0),
            np.tile(response[first:last], (len(rgb), 1)),
            start.reshape(-1, 3),
        )
        if not found.solved.all():
            raise ColourError(
                "rounding prevents a decision whether a reflectance has a colour",
                code="colour-unrealisable",
                hint="give a colour with less chroma",
            )
        xyz[:, first:last] = (found.reflectance @ light.xyz.T).reshape(len(rgb), -1, 3)
        basis[:, first:last] = found.basis.reshape(len(rgb), -1, 3)
