"""A stored cube against its rebuilding: does this version still make what was stored? (`uplift check`)"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.cube import CubeData
from uplift.difference import spectra_apart
from uplift.errors import CubeFileError
from uplift.models import reflectance
from uplift.observer import light
from uplift.sensor import Array

LIGHTS = ("D65", "A", "FL11")

LIMITS = {"rgb": 1e-5, "spectra_max": 1e-3, "spectra_rms": 1e-5} | {
    f"delta_e_{name}": 0.01 for name in LIGHTS
}
"""What may differ between machines: rounding travels through the fit, but not far."""


@dataclass(frozen=True)
class Comparison:
    """A stored cube and its rebuilding. ``measures`` as in `LIMITS`; ``counts`` of status, stored and rebuilt."""

    path: Path
    measures: dict[str, float]
    stored_counts: dict[str, int]
    rebuilt_counts: dict[str, int]

    @property
    def failures(self) -> tuple[str, ...]:
        """What is over its limit (NaN is), or differs at all where nothing may."""
        over = [name for name, value in self.measures.items() if not value <= LIMITS[name]]
        return (*over, *(["status"] if self.stored_counts != self.rebuilt_counts else []))


def compare(path: Path, stored: CubeData, rebuilt: CubeData) -> Comparison:
    """Raises `CubeFileError` where the two have no points in common."""
    if not np.array_equal(stored.lattice.nodes, rebuilt.lattice.nodes):
        raise CubeFileError("has another lattice than its options say", path=path, remedy="build it anew")
    there = stored.present | rebuilt.present
    first, second = (
        reflectance(data.model, data.coefficients[there], data.sensor.wavelengths)
        for data in (stored, rebuilt)
    )
    difference = np.abs(first - second)
    measures = {
        "rgb": float(np.abs(stored.rgb.astype(float) - rebuilt.rgb).max()),
        "spectra_max": float(difference.max()),
        "spectra_rms": float(np.sqrt((difference**2).mean())),
    }
    for name in LIGHTS:
        measures[f"delta_e_{name}"] = _largest_delta_e(name, stored.sensor.observer, first, second)
    return Comparison(path, measures, stored.counts(), rebuilt.counts())


def _largest_delta_e(name: str, observer: str, first: Array, second: Array) -> float:
    return float(spectra_apart(light(name, observer), first, second).max())
