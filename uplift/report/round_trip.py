"""Round trips RGB → spectrum → RGB of random colours."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lookup import MODES, Cube

COLOURS = 4096
SEED = 20200617
"""All reports use the same random colours, so that they can be compared."""


def round_trip_errors(cube: Cube) -> dict[str, Array]:
    """Compute ΔE00 (n,) between random colours and those of their spectra, by mode of lookup."""
    rgb, sensor = _random_rgb(cube.data), cube.data.sensor
    rgb = rgb[cube.covers(rgb)]
    return {mode: delta_e_rgb(sensor, rgb, sensor.rgb(cube.reflectance(rgb, mode=mode))) for mode in MODES}


def _random_rgb(data: CubeData) -> Array:
    """Linear RGB (n, 3), uniform in the cube or, if it is sparse, in its complete cells."""
    random = np.random.default_rng(SEED)
    rgb = random.random((COLOURS, 3))
    if data.complete_cells is None:
        return rgb
    low = data.lattice.position(random.choice(np.flatnonzero(data.complete_cells), COLOURS))
    return data.lattice.nodes[low] + rgb * (data.lattice.nodes[low + 1] - data.lattice.nodes[low])
