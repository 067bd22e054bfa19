"""Lipschitz constants of mixtures of spectra as functions of the queried colour (docs/mathematics.md, section 8).

They are those of the answers of mode ``spectra``, except in cells with a corner that has not its own colour
(`CubeData.inexact_cells`). Steps to the exact colour follow there (`uplift.lookup.refine`) and are not included.

Within a cell the answer is trilinear. Its derivative along one channel is constant in that channel and linear in each
other. The norm of the Jacobian (N × 3) is then convex along every axis, and largest at a corner of the cell, where the
derivatives are the differences along three edges.

The box of an entry e is divided into pyramids by its faces. Within a pyramid, the answer is the spectrum of the entry
plus a homogeneous function of degree one in x − e: the Jacobian is constant along a ray, and on a face linear in each
of its two coordinates between the nodes of the lattice. The maximum over the cube is one of finitely many values.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lattice import CORNERS
from uplift.lookup.interpolate import lattice_spectra
from uplift.models import reflectance

MIN_SIDE = 1e-9
"""Distance in linear RGB below which a face coincides with its entry, which then lies on the boundary of the cube."""


@dataclass(frozen=True, eq=False)
class LipschitzConstants:
    """Largest rms change of the reflectance over wavelength per unit of change of the colour.

    ``cells`` (dim − 1, dim − 1, dim − 1): maximum in each cell per unit of linear RGB (Euclidean), without entries.
    ``codes``, of the same shape: per 8-bit code, at the steepest part of the transfer curve in the cell.
    ``wavelengths`` (N,): largest change at each wavelength per unit of linear RGB, over all cells.
    ``boxes`` (E,): maximum in the box of each entry per unit of linear RGB; 0 for an entry without a box.
    """

    cells: Array
    codes: Array
    wavelengths: Array
    boxes: Array

    @property
    def largest(self) -> float:
        """Lipschitz constant of the cube per unit of linear RGB."""
        return max(float(self.cells.max()), float(self.boxes.max(initial=0)))


def lipschitz_constants(data: CubeData) -> LipschitzConstants:
    """Compute the constants of every cell and box, with two planes of spectra in memory at a time."""
    dim, nodes = data.lattice.dim, data.lattice.nodes
    sides, slope = np.diff(nodes), _largest_slopes(data)

    def plane(red: int) -> Array:
        """Spectra (dim, dim, N) of the nodes of one red value, by green and blue."""
        rows = data.points.coefficients[red * dim**2 : (red + 1) * dim**2]
        return reflectance(data.model, rows, data.sensor.wavelengths).reshape(dim, dim, -1)

    cells, codes = np.empty((dim - 1,) * 3), np.empty((dim - 1,) * 3)
    wavelengths, after = np.zeros(len(data.sensor.wavelengths)), plane(0)
    for red in range(dim - 1):
        before, after = after, plane(red + 1)
        planes = np.stack([before, after])
        jacobians = [_corner_jacobian(planes, corner, red, sides) for corner in CORNERS]
        scale = np.stack(np.broadcast_arrays(slope[red], slope[:, None], slope[None, :]), axis=-1)[..., None]
        cells[red] = np.max([spectral_norms(columns) for columns in jacobians], axis=0)
        codes[red] = np.max([spectral_norms(columns * scale) for columns in jacobians], axis=0)
        for columns in jacobians:
            wavelengths = np.maximum(wavelengths, np.linalg.norm(columns, axis=-2).max(axis=(0, 1)))
    boxes = [
        max((float(spectral_norms(columns).max()) for columns in _box_jacobians(data, entry)), default=0.0)
        for entry in range(len(data.atlas.names))
    ]
    return LipschitzConstants(cells, codes, wavelengths, np.array(boxes))


def spectral_norms(columns: Array) -> Array:
    """Spectral norms (…), divided by √N, of Jacobians whose columns are given as rows (…, 3, N)."""
    gram = columns @ columns.mT / columns.shape[-1]
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(gram)[..., -1], 0)))


def _corner_jacobian(planes: Array, corner: Array, red: int, sides: Array) -> Array:
    """Derivatives (dim − 1, dim − 1, 3, N) at one corner of every cell between two planes (2, dim, dim, N)."""
    low, high = slice(None, -1), slice(1, None)
    r = corner[0]
    green, blue = (high if step else low for step in corner[1:])
    derivatives = (
        (planes[1] - planes[0])[green, blue] / sides[red],
        (planes[r, high] - planes[r, low])[:, blue] / sides[:, None, None],
        (planes[r][:, high] - planes[r][:, low])[green] / sides[:, None],
    )
    return np.stack(derivatives, axis=-2)


def _largest_slopes(data: CubeData) -> Array:
    """Largest change (dim − 1,) of linear RGB per 8-bit code between consecutive nodes."""
    decoding, nodes = data.sensor.decoding, data.lattice.nodes
    slopes = np.diff(decoding)
    first = np.clip(np.searchsorted(decoding, nodes[:-1], side="right") - 1, 0, len(slopes) - 1)
    last = np.clip(np.searchsorted(decoding, nodes[1:], side="left"), 1, len(slopes))
    return np.array([slopes[low:high].max() for low, high in zip(first, last, strict=True)])


def _box_jacobians(data: CubeData, entry: int) -> Iterator[Array]:
    """Yield Jacobians (4, 3, N) at the corners of every patch of the faces of a box between lattice nodes."""
    if not data.atlas.half_width[entry]:
        return
    centre, cuts = data.atlas.rgb[entry], face_cuts(data, entry)
    own = data.entry_spectra.reflectance(np.array([entry]), data.sensor.wavelengths)[0]
    points = np.stack(np.meshgrid(*cuts, indexing="ij"), axis=-1)
    spectra = lattice_spectra(data, points.reshape(-1, 3), data.sensor.wavelengths)
    differences = (spectra - own).reshape(*points.shape[:3], -1)
    for axis, end in product(range(3), (0, -1)):
        if abs(cuts[axis][end] - centre[axis]) < MIN_SIDE:
            continue
        offsets, changes = (np.take(array, end, axis=axis) for array in (points - centre, differences))
        for i, j in product(range(len(changes) - 1), range(changes.shape[1] - 1)):
            yield _patch_jacobians(offsets[i : i + 2, j : j + 2], changes[i : i + 2, j : j + 2], axis)


def face_cuts(data: CubeData, entry: int) -> list[Array]:
    """Both ends of the box of an entry along each axis, and the nodes in between."""
    nodes, bounds = data.lattice.nodes, [face[entry] for face in data.entry_boxes.faces]
    return [
        np.array([low, *nodes[(nodes > low + MIN_SIDE) & (nodes < high - MIN_SIDE)], high])
        for low, high in zip(*bounds, strict=True)
    ]


def _patch_jacobians(offsets: Array, changes: Array, axis: int) -> Array:
    """Jacobians (4, 3, N) at the corners of a patch of the face normal to ``axis``.

    ``offsets`` (2, 2, 3) and ``changes`` (2, 2, N) are colours and spectra of the corners minus those of the entry.
    """
    first, second = (other for other in range(3) if other != axis)
    columns = np.empty((3, *changes.shape))
    # Along the face, differences of its corners. Along the ray, the homogeneous function is the sum of its derivatives
    # times the offsets, which gives the third one.
    columns[first] = (changes[1] - changes[0]) / (offsets[1, 0] - offsets[0, 0])[first]
    columns[second] = ((changes[:, 1] - changes[:, 0]) / (offsets[0, 1] - offsets[0, 0])[second])[:, None]
    radial = changes - offsets[..., [first]] * columns[first] - offsets[..., [second]] * columns[second]
    columns[axis] = radial / offsets[..., [axis]]
    return columns.reshape(3, 4, -1).swapaxes(0, 1)
