"""Bounds of answers: how far the colour of any reflectance of an RGB can be from the
answer's under another light.

No expected error exceeds them. For many colours, metamers are mixtures of those of the
nodes around a colour. At the ends of the RGB space, where few reflectances are
possible, they differ little.
"""

import contextlib
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.object_colours import BLOCK, solid
from uplift.colorimetry.sensor import Light, Sensor, in_unit_cube
from uplift.common.arrays import Array, Indices, Mask, blocks
from uplift.common.errors import ColourError
from uplift.cube.data import CubeData
from uplift.extras.colour.outside import reflectance_anywhere
from uplift.extras.looks import mesh, mismatch
from uplift.extras.looks.lab_errors import LabErrors, lab_errors
from uplift.lattice.lattice import Lattice
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import spectra

NODES = Lattice(np.linspace(0, 1, 5) ** 2)
"""Nodes of linear sRGB, also for wide gamuts, whose ends no reflectance has."""


@dataclass(frozen=True, eq=False, repr=False)
class Bounds:
    """Bounds of the answers to n colours under a light."""

    light: Light
    reflectance: Array
    """(n, N) the answers at the wavelengths of the sensor."""
    xyz: Array
    """(n, 3) their XYZ under the light."""
    volumes: mismatch.MismatchVolumes
    """XYZ of all reflectances of the colours."""
    largest: mismatch.LargestDifference
    """The reflectances whose colour differs most from that of the answer."""
    covariance: Array | None
    """(n, 3, 3) expected covariance of L*a*b* of a material of the colour; None without
    left-out entries.
    """
    likely_radius: float | None
    """Mahalanobis distance in a* and b* that `LIKELY` of the materials like the atlas
    stay within.
    """

    @property
    def lab(self) -> Array:
        """L*a*b* of the answers, shape (n, 3)."""
        return lab(self.xyz, self.light.white)

    @property
    def share(self) -> Array:
        """Volumes of the metamers as shares (n,) of all colours of reflectances under
        the light.
        """
        return self.volumes.volume / solid_volume(self.light.xyz)

    @property
    def box(self) -> Array:
        """Least and largest L*, a* and b* of the boundary points, shape (n, 2, 3)."""
        lab = self.volumes.lab
        return np.stack([lab.min(axis=1), lab.max(axis=1)], axis=1)

    def outline(self, row: int) -> Array:
        """Compute the outline (M, 2) in a* and b* of all colours that the reflectances
        of colour ``row`` can have.
        """
        return mesh.outline(self.volumes.lab[row, :, 1:], self.volumes.directions.faces)

    def likely(self, row: int) -> Array | None:
        """Compute the ellipse (M, 2) in a* and b* that holds `LIKELY` of the materials
        like the atlas, if known.
        """
        if self.covariance is None or self.likely_radius is None:
            return None
        values, axes = np.linalg.eigh(self.covariance[row, 1:, 1:])
        # With Σ = V Λ Vᵀ, the ellipse is μ + radius · V √Λ (cos, sin).
        turn = np.linspace(0, 2 * np.pi, 73)[:-1]
        circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return (
            self.lab[row, 1:]
            + self.likely_radius * (circle * np.sqrt(np.maximum(values, 0))) @ axes.T
        )


def bounds(
    cube: Cube,
    rgb: Array,
    light: Light,
    mode: str = "spectra",
    divisions: int = mismatch.DIVISIONS,
) -> Bounds:
    """Compute bounds of the answers to linear RGB (n, 3) under a light at the
    wavelengths of the sensor.

    Colours outside [0, 1] are answered by `reflectance_anywhere`; ``divisions`` (0 to
    4) sets the number of boundary points, see `uplift.extras.looks.mismatch.COUNTS`.
    Raises `ColourError` if no reflectance has a colour.
    """
    data = cube.data
    volumes = mismatch.mismatch_volumes(data.sensor, light, rgb, divisions)
    spectra = reflectance_anywhere(
        data, rgb, data.sensor.wavelengths, mode, ~in_unit_cube(rgb)
    )
    errors = None if data.atlas.left_out is None else lab_errors(data, light)
    return bounds_around(light, spectra, volumes, rgb, errors)


def bounds_around(
    light: Light,
    spectra: Array,
    volumes: mismatch.MismatchVolumes,
    rgb: Array,
    errors: LabErrors | None,
) -> Bounds:
    """Return the bounds around answers (n, N) to linear RGB (n, 3)."""
    xyz = spectra @ light.xyz.T
    largest = mismatch.largest_difference(volumes, xyz)
    covariance = None if errors is None else errors.covariance(rgb)
    radius = None if errors is None else errors.likely_radius
    return Bounds(light, spectra, xyz, volumes, largest, covariance, radius)


def limit_errors(data: CubeData, light: Light, rgb: Array, errors: Array) -> Array:
    """Limit expected errors (n, k) of the answers to linear RGB (n, 3) by the ΔE00 to
    metamers under a light.
    """
    srgb = rgb @ conversion(data.sensor, SRGB).T
    corners, weights = NODES.corners(srgb.clip(0, 1))
    nodes = _nodes(data.sensor, light)
    nodes.add(corners)
    metamers = np.einsum("nc,ncdk->ndk", weights, nodes.metamers[corners])
    unknown = ~in_unit_cube(srgb) | np.isnan(metamers).any(axis=(1, 2))
    if unknown.any():
        metamers[unknown] = _extremes(data.sensor, light, rgb[unknown])
    answers = spectra(data, rgb, data.sensor.wavelengths) @ light.xyz.T
    reference = lab(answers, light.white)[:, None]
    possible = delta_e_2000(lab(metamers, light.white), reference)
    return np.fmin(errors, possible.max(axis=1, keepdims=True))


@dataclass(frozen=True, eq=False)
class NodeMetamers:
    """Metamers at `NODES`, added when a colour needs them: a query needs few."""

    sensor: Sensor
    light: Light
    metamers: Array
    """(125, d, 3) XYZ, NaN where they are not known."""
    known: Mask

    def add(self, corners: Indices) -> None:
        """Compute the metamers at corners (n, 4)."""
        needed = np.zeros_like(self.known)
        needed[corners] = True
        missing = np.flatnonzero(needed & ~self.known)
        if len(missing):
            to_rgb = np.linalg.inv(conversion(self.sensor, SRGB))
            rgb = NODES.points[missing] @ to_rgb.T
            self.metamers[missing] = _extremes(self.sensor, self.light, rgb)
            self.known[missing] = True


@lru_cache(maxsize=16)
def _nodes(sensor: Sensor, light: Light) -> NodeMetamers:
    count = len(NODES.points)
    metamers = np.full((count, mismatch.COUNTS[0], 3), np.nan)
    return NodeMetamers(sensor, light, metamers, np.zeros(count, dtype=bool))


def _extremes(sensor: Sensor, light: Light, rgb: Array) -> Array:
    """XYZ (n, d, 3) of the metamers that differ most; NaN for colours that no
    reflectance has.
    """
    with contextlib.suppress(ColourError):
        return mismatch.mismatch_volumes(sensor, light, rgb, 0).xyz
    xyz = np.full((len(rgb), mismatch.COUNTS[0], 3), np.nan)
    real = solid(sensor.matrix).contains(rgb)
    with contextlib.suppress(ColourError):
        xyz[real] = mismatch.mismatch_volumes(sensor, light, rgb[real], 0).xyz
    return xyz


def solid_volume(matrix: Array) -> float:
    """Compute the volume of the object-colour solid of three responses (3, N).

    The zonotope consists of a parallelepiped for each triple of segments; each pair of
    segments takes part in those of all third ones.
    """
    first, second = np.triu_indices(matrix.shape[1], k=1)
    normals = np.cross(matrix.T[first], matrix.T[second])
    parts = (normals[block] for block in blocks(len(normals), BLOCK))
    return float(sum(np.abs(part @ matrix).sum() for part in parts) / 3)
