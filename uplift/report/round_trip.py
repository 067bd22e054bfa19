"""Random colours that go through a cube and come back."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lookup import MODES, Cube

COLOURS = 4096
SEED = 20200617
"""Of the random colours: the same for every report, so that reports compare."""


def round_trips(cube: Cube) -> dict[str, Array]:
    """ΔE00 (n,) under the cube's illuminant between random linear RGB and what comes back, for each mode."""
    asked, sensor = _random(cube.data), cube.data.sensor
    asked = asked[cube.holds(asked)]
    return {
        mode: delta_e_rgb(sensor, asked, sensor.rgb(cube.reflectance(asked, mode=mode))) for mode in MODES
    }


def _random(data: CubeData) -> Array:
    """Linear RGB (n, 3), even in the cube or, where it is sparse, in its complete cells."""
    random = np.random.default_rng(SEED)
    asked = random.random((COLOURS, 3))
    if data.complete_cells is None:
        return asked
    low = data.lattice.position(random.choice(np.flatnonzero(data.complete_cells), COLOURS))
    return data.lattice.nodes[low] + asked * (data.lattice.nodes[low + 1] - data.lattice.nodes[low])
