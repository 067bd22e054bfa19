"""Mismatch volumes: all colours that the reflectances of one RGB can have under another
light.

Of all reflectances in [0, 1] with linear RGB r under the build illuminant, the XYZ
under a second light fill a convex body: the object-colour solid of the six sensors, cut
at r. In each direction its boundary is the XYZ of one extreme reflectance
(`uplift.extras.looks.extreme_spectra`). Colours that are known under further lights are
further sensors, which cut the body.

ΔE00 is not convex, so the search for the metamer that differs most from a given one
starts in 20 parts of the volume: the triangles of directions within each triangle of
the icosahedron. Each step goes to the extreme in the direction in which ΔE00 rises
fastest at the current one. Finally, directions close to that of the best metamer are
tried.

References
----------
Finlayson & Morovic 2005, "Metamer sets", JOSA A 22(5). Logvinenko, Funt & Godau 2014,
"Metamer mismatching", IEEE Transactions on Image Processing 23(1).
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab, lab_jacobian
from uplift.colorimetry.object_colours import solid
from uplift.colorimetry.sensor import Light, Sensor, format_rgb
from uplift.common.arrays import Array, Indices, blocks
from uplift.common.errors import ColourError
from uplift.extras.looks.extreme_spectra import extreme_spectra, first_basis
from uplift.extras.looks.mesh import Sphere, mesh_volume, sphere

COUNTS = (12, 42, 162, 642, 2562)
"""Directions after 0 to 4 divisions of the icosahedron."""
DIVISIONS = 2
"""Divisions of the icosahedron: 162 directions."""
MIN_SCALE = 1e-6
"""Smallest scale of a direction, relative to the light: the volume of the build
illuminant is a point.
"""
BLOCK_PROBLEMS = 1 << 14
"""Colours times directions processed at a time."""
PARTS = 20
"""Triangles of the icosahedron; a triangle of a divided one belongs to that of its
number modulo this.
"""
MAX_STEPS = 20
DIFFERENCE_STEP = 1e-3
"""Step in L*a*b* of the differences that approximate the derivative of ΔE00."""
REFINEMENTS = 3
MIN_RISE = 1e-9
"""Rise of ΔE00 below which the search ends."""


RING = np.concatenate([size * sphere(0).directions for size in (0.4, 0.15, 0.05)])
"""Changes of a direction of length 1 that are tried around the most different metamer.
"""


class KnownColours(NamedTuple):
    """Linear RGB of n colours under L lights, K = 3 L numbers each."""

    matrix: Array
    """(K, N) from reflectances to the numbers."""
    values: Array
    """(n, K)"""

    def take(self, rows: Indices | slice) -> "KnownColours":
        """Select some of the colours."""
        return KnownColours(self.matrix, self.values[rows])


@dataclass(frozen=True, eq=False, repr=False)
class MismatchVolumes:
    """Mismatch volumes of n colours under a light."""

    known: KnownColours
    """The colours under the build illuminant, and under further lights."""
    light: Light
    """The light of the volumes."""
    directions: Sphere
    """D directions in the scaled space, and the triangles between them."""
    scale: Array
    """(3, 3) From the scaled space to XYZ."""
    xyz: Array
    """(n, D, 3) XYZ on the boundary, the extreme of each direction."""
    basis: Indices
    """(n, D, K) Wavelengths at which the extreme reflectances are neither 0 nor 1."""

    @property
    def rgb(self) -> Array:
        """Linear RGB under the build illuminant, shape (n, 3)."""
        return self.known.values[:, :3]

    @cached_property
    def lab(self) -> Array:
        """L*a*b* on the boundary, shape (n, D, 3)."""
        return lab(self.xyz, self.light.white)

    @cached_property
    def volume(self) -> Array:
        """Volumes (n,) in XYZ of the meshes between the boundary points: less than
        those of the bodies.
        """
        return mesh_volume(self.xyz, self.directions.faces)

    @cached_property
    def normals(self) -> Array:
        """Unit vectors (D, 3) of XYZ, in whose directions the boundary points are the
        extremes.
        """
        normals = self.directions.directions @ np.linalg.inv(self.scale)
        return normals / np.linalg.norm(normals, axis=1)[:, None]

    @cached_property
    def corners(self) -> Array:
        """XYZ (n, F, 3) whose convex hull contains the body: where the planes of three
        neighbours meet.
        """
        faces = self.directions.faces
        directions = self.directions.directions
        scaled = self.xyz @ np.linalg.inv(self.scale).T
        support = np.einsum("kdi,di->kd", scaled, directions)[:, faces]
        return (
            np.einsum("fij,kfj->kfi", np.linalg.inv(directions[faces]), support)
            @ self.scale.T
        )

    def excess(self, xyz: Array) -> Array:
        """Compute by how much (n,) XYZ (n, 3) exceed the body in the direction in which
        they do so most.
        """
        return np.einsum("kdi,di->kd", xyz[:, None] - self.xyz, self.normals).max(
            axis=1
        )


def mismatch_volumes(
    sensor: Sensor,
    light: Light,
    rgb: Array,
    divisions: int = DIVISIONS,
    further: KnownColours | None = None,
) -> MismatchVolumes:
    """Compute the mismatch volumes of colours under a light. Shapes: ``rgb`` (n, 3).

    ``further`` are their colours under further lights. Raises `ColourError` if no
    reflectance has a colour, or all colours of one row.
    """
    outside = np.flatnonzero(~solid(sensor.matrix).contains(rgb))
    if outside.size:
        raise _unrealisable(
            f"no reflectance has the colour {format_rgb(rgb[outside[0]])} under "
            f"{sensor.illuminant}"
        )
    known = KnownColours(sensor.matrix, rgb)
    if further is not None:
        matrix = np.concatenate([sensor.matrix, further.matrix])
        values = np.concatenate([rgb, further.values], axis=1)
        known = KnownColours(matrix, values)
    directions = sphere(divisions)
    scale = _scale(known.matrix, light)
    # A direction d of the scaled space S⁻¹ x is maximised by the response dᵀ S⁻¹ X of
    # each wavelength.
    response = directions.directions @ np.linalg.solve(scale, light.xyz)
    xyz = np.empty((len(rgb), len(response), 3))
    basis = np.empty((len(rgb), len(response), len(known.matrix)), dtype=np.intp)
    parents = directions.parents
    for block in blocks(len(rgb), max(BLOCK_PROBLEMS // len(response), 1)):
        colours = known.take(block)
        _solve(colours, light, response, parents, xyz[block], basis[block])
    return MismatchVolumes(known, light, directions, scale, xyz, basis)


def _unrealisable(problem: str) -> ColourError:
    return ColourError(
        problem, code="colour-unrealisable", hint="give a colour with less chroma"
    )


def _scale(matrix: Array, light: Light) -> Array:
    """Square root of the products of the responses of the light that those of sensors
    (K, N) do not explain.
    """
    # With P the projection to the sensors' responses, S = ((X − P X)(X − P X)ᵀ)^½.
    explained = np.linalg.lstsq(matrix.T, light.xyz.T, rcond=None)[0]
    unexplained = light.xyz - explained.T @ matrix
    squares, axes = np.linalg.eigh(unexplained @ unexplained.T)
    lengths = np.sqrt(np.maximum(squares, MIN_SCALE**2 * (light.xyz**2).sum()))
    return (axes * lengths) @ axes.T


def _solve(
    known: KnownColours,
    light: Light,
    response: Array,
    parents: Indices,
    xyz: Array,
    basis: Indices,
) -> None:
    """Fill the boundary points (n, D, 3), from coarse to fine: each direction starts at
    its parent's optimum.
    """
    matrix, values = known
    basis[:] = first_basis(matrix)
    for first, last in pairwise((0, *COUNTS)):
        if first >= len(parents):
            break
        start = basis[:, parents[first:last]] if first else basis[:, :last]
        colours = np.repeat(values, last - first, axis=0)
        responses = np.tile(response[first:last], (len(values), 1))
        extremes = extreme_spectra(
            matrix, colours, responses, start.reshape(-1, len(matrix))
        )
        if not extremes.solved.all():
            raise _unsolved(len(matrix))
        points = extremes.reflectance @ light.xyz.T
        xyz[:, first:last] = points.reshape(len(values), -1, 3)
        basis[:, first:last] = extremes.basis.reshape(len(values), -1, len(matrix))


def _unsolved(count: int) -> ColourError:
    if count == 3:
        return _unrealisable(
            "rounding prevents a decision whether a reflectance has a colour"
        )
    return ColourError(
        "no reflectance has these colours under all lights",
        code="colour-unrealisable",
        hint="check the lights and the white balance of the colours",
    )


@dataclass(frozen=True, eq=False)
class LargestDifference:
    """The metamers that differ most from given ones, n of them."""

    delta_e_2000: Array
    """(n,) ΔE00 of the most different metamer that was found."""
    outer: Array
    """(n,) Largest ΔE00 to a corner of the polyhedron around the volume, at least
    ``delta_e_2000``. A difference that grows along all straight lines from the given
    colour would be bounded by it; ΔE00 nearly does.
    """
    xyz: Array
    """(n, 3) XYZ of the most different metamers."""


def largest_difference(volumes: MismatchVolumes, xyz: Array) -> LargestDifference:
    """Find the metamers that differ most from given ones. Shapes: ``xyz`` (n, 3)."""
    white = volumes.light.white
    reference = lab(xyz, white)
    sampled = delta_e_2000(volumes.lab, reference[:, None])
    corners = volumes.corners
    outer = delta_e_2000(lab(corners, white), reference[:, None])
    faces = outer.reshape(len(outer), -1, PARTS).argmax(axis=1) * PARTS + np.arange(
        PARTS
    )
    row = np.repeat(np.arange(len(xyz)), PARTS)
    faces = faces.ravel()
    basis = volumes.basis[row, volumes.directions.faces[faces, 0]]
    search = _Search(volumes, reference)
    slope = search.slope(row, corners[row, faces])
    ascended = search.ascend(row, slope, basis)
    normals = np.broadcast_to(volumes.normals, volumes.xyz.shape)
    best = _most_different(
        len(xyz), _Metamers(sampled, volumes.xyz, normals, volumes.basis), ascended
    )
    for _ in range(REFINEMENTS):
        best = search.around(best)
    return LargestDifference(
        best.delta_e, np.maximum(outer.max(axis=1), best.delta_e), best.xyz
    )


class _Metamers(NamedTuple):
    delta_e: Array
    """(..., )"""
    xyz: Array
    """(..., 3)"""
    direction: Array
    """(..., 3) of XYZ, in which the metamer is the extreme."""
    basis: Indices
    """(..., K)"""


def _most_different(count: int, *parts: _Metamers) -> _Metamers:
    """Choose the most different metamer of each of n colours, of which each part has
    the same number in order.
    """
    delta_e, *others = zip(*parts, strict=True)
    differences = np.concatenate([each.reshape(count, -1) for each in delta_e], axis=1)
    best = np.arange(count), differences.argmax(axis=1)
    chosen = []
    for other in others:
        width = other[0].shape[-1]
        joined = np.concatenate(
            [each.reshape(count, -1, width) for each in other], axis=1
        )
        chosen.append(joined[best])
    return _Metamers(differences[best], *chosen)


@dataclass(frozen=True, eq=False)
class _Search:
    volumes: MismatchVolumes
    reference: Array
    """(n, 3) L*a*b* of the given metamers."""

    def extremes(self, row: Indices, direction: Array, basis: Indices) -> _Metamers:
        """Metamers (m,) of colours (m,) in directions (m, 3) of XYZ."""
        light = self.volumes.light
        matrix, values = self.volumes.known.take(row)
        extreme = extreme_spectra(matrix, values, direction @ light.xyz, basis)
        xyz = extreme.reflectance @ light.xyz.T
        delta_e = delta_e_2000(self._lab(xyz), self.reference[row])
        return _Metamers(delta_e, xyz, direction, extreme.basis)

    def ascend(self, row: Indices, slope: Array, basis: Indices) -> _Metamers:
        """Metamers (m,) where the steps from the extremes in the directions
        (m, 3) end.
        """
        metamers = self.extremes(row, slope, basis)
        rises = np.arange(len(row))
        for _ in range(MAX_STEPS):
            trial = self.extremes(
                row[rises],
                self.slope(row[rises], metamers.xyz[rises]),
                metamers.basis[rises],
            )
            better = trial.delta_e > metamers.delta_e[rises] + MIN_RISE
            rises = rises[better]
            if not len(rises):
                break
            for array, new in zip(metamers, trial, strict=True):
                array[rises] = new[better]
        return metamers

    def around(self, best: _Metamers) -> _Metamers:
        """The most different of metamers (n,) and of those in directions
        around theirs.
        """
        count = len(best.delta_e)
        scale = self.volumes.scale
        middle = best.direction @ scale
        middle /= np.linalg.norm(middle, axis=1)[:, None]
        directions = (middle[:, None] + RING) @ np.linalg.inv(scale)
        row = np.repeat(np.arange(count), len(RING))
        ring = self.extremes(
            row, directions.reshape(-1, 3), np.repeat(best.basis, len(RING), axis=0)
        )
        return _most_different(count, best, ring)

    def slope(self, row: Indices, xyz: Array) -> Array:
        """Derivative (m, 3) of ΔE00 with respect to XYZ (m, 3)."""
        at = self._lab(xyz)[:, None]
        steps = DIFFERENCE_STEP * np.eye(3)
        reference = self.reference[row, None]
        rise = delta_e_2000(at + steps, reference) - delta_e_2000(at - steps, reference)
        jacobian = lab_jacobian(xyz, self.volumes.light.white)
        return (rise[:, None, :] @ jacobian)[:, 0] / (2 * DIFFERENCE_STEP)

    def _lab(self, xyz: Array) -> Array:
        return lab(xyz, self.volumes.light.white)
