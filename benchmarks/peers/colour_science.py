"""colour-science's LUT3D_Jakob2019: the table of Jakob & Hanika 2019, fitted in Python."""

from __future__ import annotations

from importlib.metadata import version

import colour
import numpy as np
from colour.recovery.jakob2019 import lightness_scale

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.models.sigmoid import evaluate_unscaled

SIZE = 3
LEAST, WITHIN = 0.8, 1e-2
"""It stops at a ΔE, not at an RGB."""


def colour_science(runs: int) -> list[Peer]:
    """A small table; a large one goes from point to point in shorter steps."""
    sensor = task.sensor()
    space = colour.RGB_COLOURSPACES[sensor.space]
    cmfs, light = observer.aligned(sensor)
    table = colour.recovery.LUT3D_Jakob2019()

    def generate() -> Array:
        table.generate(space, cmfs, light, SIZE, print_callable=lambda *_: None)
        return table.coefficients.reshape(-1, 3)

    target = _points(SIZE)
    coefficients, cpu = task.measured(generate, len(target), runs)
    answer = judge(sensor.rgb(evaluate_unscaled(coefficients, sensor.wavelengths)), target, least=LEAST, within=WITHIN)
    tool = f"colour-science {version('colour-science')} `LUT3D_Jakob2019`"
    notes = f"a table of size {SIZE}, 3 × {SIZE}³ points; it stops at a ΔE"
    return [Peer(tool, "sigmoid", 3, len(target), cpu, answer, notes)]


def _points(size: int) -> Array:
    """Linear RGB (n, 3) of all points of a table.

    One part for each largest component; within it by the value of that component, then by the shares of the next
    two, in cyclic order.
    """
    shares = np.linspace(0, 1, size)
    value, last, middle = np.meshgrid(lightness_scale(size), shares, shares, indexing="ij")
    bright = np.stack([value, value * middle, value * last], axis=-1)
    return np.stack([np.roll(bright, part, axis=-1) for part in range(3)]).reshape(-1, 3)
