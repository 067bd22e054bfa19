"""Possible errors of answers: ΔE00 to metamers, which no expected error exceeds.

Mixtures of metamers of the nodes around a colour are metamers of the colour. At the
ends of the RGB space, where few reflectances are possible, they differ little.
"""

from functools import lru_cache

import numpy as np

from uplift.colorimetry import Light, Sensor, delta_e_2000, lab, solid
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.extras.looks.mismatch import COUNTS, mismatch_volumes
from uplift.lattice import Lattice
from uplift.lookup.interpolate import spectra

NODES = Lattice(np.linspace(0, 1, 5) ** 2)
"""Nodes whose metamers are computed."""


def possible_errors(data: CubeData, light: Light, rgb: Array) -> Array:
    """Compute the largest ΔE00 (n,) from the answers to linear RGB (n, 3) to metamers
    under a light; NaN next to colours that no reflectance has.
    """
    corners, weights = NODES.cell_corners(*NODES.cell(rgb))
    points, row = np.unique(corners[weights > 0], return_inverse=True)
    nodes = _metamers(data.sensor, light.xyz.tobytes(), tuple(points.tolist()))
    metamers = np.zeros((*corners.shape, *nodes.shape[1:]))
    metamers[weights > 0] = nodes[row]
    mixed = np.einsum("nc,ncdk->ndk", weights, metamers)
    xyz = spectra(data, rgb, data.sensor.wavelengths) @ light.xyz.T
    answers = lab(xyz, light.white)[:, None]
    return delta_e_2000(lab(mixed, light.white), answers).max(axis=1)


@lru_cache(maxsize=NODES.size)
def _metamers(sensor: Sensor, weights: bytes, points: tuple[int, ...]) -> Array:
    """XYZ (m, d, 3) of the metamers of nodes that differ most under a light; NaN for
    colours that no reflectance has.
    """
    light = Light("", np.frombuffer(weights).reshape(3, -1))
    rgb = NODES.points[list(points)]
    xyz = np.full((len(rgb), COUNTS[0], 3), np.nan)
    real = solid(sensor.matrix).contains(rgb)
    xyz[real] = mismatch_volumes(sensor, light, rgb[real], 0).xyz
    return xyz
