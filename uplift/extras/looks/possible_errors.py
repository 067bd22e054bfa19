"""Possible errors of answers: ΔE00 to metamers, which no expected error exceeds.

Mixtures of metamers of the nodes around a colour are metamers of the colour. At the
ends of the RGB space, where few reflectances are possible, they differ little.
"""

import contextlib
from functools import lru_cache

import numpy as np

from uplift.colorimetry import Light, Sensor, delta_e_2000, in_unit_cube, lab, solid
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.common.arrays import Array
from uplift.common.errors import ColourError
from uplift.cube import CubeData
from uplift.extras.looks.mismatch import COUNTS, mismatch_volumes
from uplift.lattice import Lattice
from uplift.lookup.interpolate import spectra

NODES = Lattice(np.linspace(0, 1, 5) ** 2)
"""Nodes of linear sRGB whose metamers are computed, also for wide gamuts, of whose ends
no reflectance has the colours.
"""


def possible_errors(data: CubeData, light: Light, rgb: Array) -> Array:
    """Compute the largest ΔE00 (n,) from the answers to linear RGB (n, 3) to metamers
    under a light; NaN for colours that no reflectance has.
    """
    sensor = data.sensor
    srgb = rgb @ conversion(sensor, SRGB).T
    corners, weights = NODES.cell_corners(*NODES.cell(srgb.clip(0, 1)))
    nodes = _nodes(sensor, light)[corners]
    metamers = np.einsum("nc,ncdk->ndk", weights, nodes)
    unknown = ~in_unit_cube(srgb) | np.isnan(metamers).any(axis=(1, 2))
    metamers[unknown] = _extremes(sensor, light, rgb[unknown])
    answers = spectra(data, rgb, sensor.wavelengths) @ light.xyz.T
    reference = lab(answers, light.white)[:, None]
    return delta_e_2000(lab(metamers, light.white), reference).max(axis=1)


@lru_cache(maxsize=16)
def _nodes(sensor: Sensor, light: Light) -> Array:
    rgb = NODES.points @ np.linalg.inv(conversion(sensor, SRGB)).T
    return _extremes(sensor, light, rgb)


def _extremes(sensor: Sensor, light: Light, rgb: Array) -> Array:
    """XYZ (n, d, 3) of the metamers that differ most; NaN for colours that no
    reflectance has.
    """
    xyz = np.full((len(rgb), COUNTS[0], 3), np.nan)
    real = solid(sensor.matrix).contains(rgb)
    with contextlib.suppress(ColourError):
        xyz[real] = mismatch_volumes(sensor, light, rgb[real], 0).xyz
    return xyz
