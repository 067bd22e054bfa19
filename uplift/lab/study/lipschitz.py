"""How fast the answers of mode ``spectra`` change with the colour asked: the Lipschitz constant, exactly.

Within a cell the answer is trilinear, so that its derivative along one channel does not depend on that channel and
is linear in each of the others; the norm of the Jacobian (N × 3) is then convex along every axis, and largest at one
of the cell's corners, where the derivatives are the differences along three edges. Within the box of an entry e,
cut into pyramids by its faces, the answer is the entry's spectrum plus what is homogeneous of degree one in x − e: the
Jacobian is the same all along a ray, and on a face is linear in each of the two coordinates of the face, cut up by
the lattice. So the largest value over the whole cube is among finitely many. (docs/mathematics.md, 8)
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

THIN = 1e-9
"""Linear RGB below which a face does not stand apart from its entry: the entry lies on the cube's edge."""


@dataclass(frozen=True, eq=False)
class LipschitzConstants:
    """The largest rms over wavelength of the change of the answer, per unit of change of the colour.

    Parameters
    ----------
    cells : (dim − 1, dim − 1, dim − 1) within each cell, per unit of linear RGB (Euclidean), entries aside.
    codes : the same, per 8-bit code of the space (Euclidean), its curve taken where it is steepest in the cell.
    waves : (N,) the largest change at each wavelength, per unit of linear RGB, over all cells.
    boxes : (E,) within the box of each entry, per unit of linear RGB; 0 for one without a box.
    """

    cells: Array
    codes: Array
    waves: Array
    boxes: Array

    @property
    def largest(self) -> float:
        """The Lipschitz constant of the whole cube, per unit of linear RGB."""
        return max(float(self.cells.max()), float(self.boxes.max(initial=0)))


def lipschitz_constants(data: CubeData) -> LipschitzConstants:
    """Of every cell and box. Two planes of spectra are in memory at a time."""
    dim, nodes = data.lattice.dim, data.lattice.nodes
    sides, slope = np.diff(nodes), _steepest_curve(data)
    cells, codes = np.empty((dim - 1,) * 3), np.empty((dim - 1,) * 3)
    waves = np.zeros(len(data.sensor.wavelengths))
    before = _plane(data, 0)
    for red in range(dim - 1):
        after = _plane(data, red + 1)
        both = np.stack([before, after])
        corners = [_columns(both, corner, red, sides) for corner in CORNERS]
        scale = np.stack(np.broadcast_arrays(slope[red], slope[:, None], slope[None, :]), axis=-1)
        cells[red] = np.max([spectral_norms(columns) for columns in corners], axis=0)
        codes[red] = np.max([spectral_norms(columns * scale[..., None]) for columns in corners], axis=0)
        for columns in corners:
            waves = np.maximum(waves, np.linalg.norm(columns, axis=-2).max(axis=(0, 1)))
        before = after
    return LipschitzConstants(cells, codes, waves, _boxes(data))


def spectral_norms(columns: Array) -> Array:
    """The largest rms (…) that columns (…, 3, N), the derivatives along three axes, give any unit direction."""
    gram = columns @ columns.mT / columns.shape[-1]
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(gram)[..., -1], 0)))


def _plane(data: CubeData, red: int) -> Array:
    """(dim, dim, N) spectra of the points of one red, green first."""
    dim = data.lattice.dim
    rows = data.points.coefficients[red * dim**2 : (red + 1) * dim**2]
    return reflectance(data.model, rows, data.sensor.wavelengths).reshape(dim, dim, -1)


def _columns(both: Array, corner: Array, red: int, sides: Array) -> Array:
    """Derivatives (dim − 1, dim − 1, 3, N) at one corner of every cell between two planes (2, dim, dim, N)."""
    r, g, b = corner
    low, high = slice(None, -1), slice(1, None)
    green, blue = (high if step else low for step in (g, b))
    along = (
        (both[1] - both[0])[green, blue] / sides[red],
        (both[r, high] - both[r, low])[:, blue] / sides[:, None, None],
        (both[r][:, high] - both[r][:, low])[green] / sides[:, None],
    )
    return np.stack(along, axis=-2)


def _steepest_curve(data: CubeData) -> Array:
    """(dim − 1,) linear RGB per 8-bit code, where it is most between one node and the next."""
    decoding = data.sensor.decoding
    slopes, nodes = np.diff(decoding), data.lattice.nodes
    first = np.clip(np.searchsorted(decoding, nodes[:-1], side="right") - 1, 0, len(slopes) - 1)
    last = np.clip(np.searchsorted(decoding, nodes[1:], side="left"), 1, len(slopes))
    return np.array([slopes[low:high].max() for low, high in zip(first, last, strict=True)])


def _boxes(data: CubeData) -> Array:
    return np.array([_box(data, entry) for entry in range(len(data.atlas.names))])


def _box(data: CubeData, entry: int) -> float:
    """The largest norm within the box of an entry."""
    if not data.atlas.half_width[entry]:
        return 0.0
    own = reflectance(data.model, data.atlas.coefficients[entry : entry + 1], data.sensor.wavelengths)[0]
    return max(float(spectral_norms(columns).max()) for columns in _faces(data, entry, own))


def _faces(data: CubeData, entry: int, own: Array) -> Iterator[Array]:
    """Jacobians (4, 3, N) at the corners of every patch that the lattice cuts the faces of a box into."""
    low, high = (face[entry] for face in data.entry_boxes.faces)
    middle, nodes = data.atlas.rgb[entry], data.lattice.nodes
    cuts = [_cuts(nodes, low[axis], high[axis]) for axis in range(3)]
    points = np.stack(np.meshgrid(*cuts, indexing="ij"), axis=-1)
    apart = (lattice_spectra(data, points.reshape(-1, 3), data.sensor.wavelengths) - own).reshape(
        *points.shape[:3], -1
    )
    for axis, end in product(range(3), (0, -1)):
        if abs(cuts[axis][end] - middle[axis]) < THIN:
            continue
        away, face = (np.take(array, end, axis=axis) for array in (points - middle, apart))
        for i, j in product(range(len(face) - 1), range(face.shape[1] - 1)):
            yield _patch(away[i : i + 2, j : j + 2], face[i : i + 2, j : j + 2], axis)


def _patch(away: Array, apart: Array, axis: int) -> Array:
    """Jacobians (4, 3, N) at the corners of a patch of a face that ``axis`` stands upright on.

    ``away`` (2, 2, 3) and ``apart`` (2, 2, N) are the corners' colours and spectra, less the entry's.
    """
    first, second = (other for other in range(3) if other != axis)
    along_first = np.broadcast_to((apart[1] - apart[0]) / (away[1, 0] - away[0, 0])[first], apart.shape)
    steps = (apart[:, 1] - apart[:, 0]) / (away[0, 1] - away[0, 0])[second]
    along_second = np.broadcast_to(steps[:, None], apart.shape)
    outward = apart - away[..., [first]] * along_first - away[..., [second]] * along_second
    found = np.empty((4, 3, apart.shape[-1]))
    parts = {axis: outward / away[..., [axis]], first: along_first, second: along_second}
    for column, part in parts.items():
        found[:, column] = part.reshape(4, -1)
    return found


def _cuts(nodes: Array, low: float, high: float) -> Array:
    """The ends of a side of a face, and the nodes between them."""
    return np.array([low, *nodes[(nodes > low + THIN) & (nodes < high - THIN)], high])
