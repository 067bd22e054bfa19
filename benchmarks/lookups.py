"""Colours per second of a lookup in numpy, by mode, the round trip checked first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.timing import ROOT, Spread, timed
from uplift.lookup import MODES, load

COLOURS = 100_000
WAVELENGTHS = np.linspace(400, 700, 16)


@dataclass(frozen=True)
class LookupTiming:
    """Seconds for ``colours`` colours at once; ``worst`` is max |linear RGB| of the round trip, where there is one."""

    what: str
    wall: Spread
    worst: float | None
    colours: int = COLOURS


def time_lookups(runs: int) -> list[LookupTiming]:
    cube = load(ROOT / "cubes" / "moments-16-macbeth.uplift")
    rgb = np.random.default_rng(1).random((COLOURS, 3))
    timings = [LookupTiming("coefficients", timed(lambda: cube.coefficients(rgb), runs)[0], None)]
    for mode in MODES:
        worst = float(
            np.abs(cube.data.sensor.rgb(cube.reflectance(rgb[:5000], mode=mode)) - rgb[:5000]).max()
        )
        cube.reflectance(rgb, WAVELENGTHS, mode)
        wall, _ = timed(lambda mode=mode: cube.reflectance(rgb, WAVELENGTHS, mode), runs)
        timings.append(LookupTiming(f"reflectance at 16 wavelengths, mode {mode}", wall, worst))
    return timings
