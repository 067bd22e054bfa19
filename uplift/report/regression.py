"""A stored cube against its rebuilding: does this version still make what was stored? (`uplift check`)"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import REGRESSION_LIGHTS
from uplift.colorimetry.observer import light
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array, Mask
from uplift.common.errors import CubeFileError
from uplift.cube import CubeData
from uplift.lattice import Status
from uplift.models import reflectance

LIMITS = {"rgb": 1e-6, "spectra_max": 1e-5, "spectra_rms": 1e-7} | {
    f"delta_e_{name}": 1e-4 for name in REGRESSION_LIGHTS
}
"""What may differ between machines: some hundred times what other instruction sets were seen to change
(docs/stability-determinism.json). Within one machine nothing differs, whatever the threads."""
UNSETTLED = 1e-3
"""Linear RGB from the boundary of what reflectances reach, where wide spaces have points: their spectra are nearly
boxes, and many that meet the colour as well; rounding takes its pick."""


@dataclass(frozen=True)
class Comparison:
    """A stored cube and its rebuilding. ``measures`` as in `LIMITS`, of settled points; ``counts`` of their status,
    and of all that are unfitted, stored and rebuilt."""

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
    """Compare all points but the unsettled. Raises `CubeFileError` where the two have no points in common."""
    if not np.array_equal(stored.lattice.nodes, rebuilt.lattice.nodes):
        raise CubeFileError("has another lattice than its options say", path=path, hint="build it anew")
    settled = _settled(stored) & (stored.points.present | rebuilt.points.present)
    first, second = (
        reflectance(data.model, data.points.coefficients[settled], data.sensor.wavelengths)
        for data in (stored, rebuilt)
    )
    difference = np.abs(first - second)
    measures = {
        "rgb": float(np.abs(stored.points.rgb.astype(float) - rebuilt.points.rgb)[settled].max()),
        "spectra_max": float(difference.max()),
        "spectra_rms": float(np.sqrt((difference**2).mean())),
    }
    for name in REGRESSION_LIGHTS:
        measures[f"delta_e_{name}"] = _largest_delta_e(name, stored.sensor.observer, first, second)
    return Comparison(path, measures, *(_counts(data, settled) for data in (stored, rebuilt)))


def _settled(data: CubeData) -> Mask:
    """Points (n,) whose spectra are the same on any machine; all, where the space holds no unrealisable point."""
    if Status.UNREALISABLE not in data.points.status:
        return np.ones(data.lattice.size, dtype=bool)
    return np.asarray(solid(data.sensor.matrix).signed_distance(data.lattice.points) < -UNSETTLED)


def _counts(data: CubeData, settled: Mask) -> dict[str, int]:
    unfitted = int((data.points.status == Status.UNFITTED).sum())
    return replace(data.points, status=data.points.status[settled]).counts() | {
        Status.UNFITTED.label: unfitted
    }


def _largest_delta_e(name: str, observer: str, first: Array, second: Array) -> float:
    return float(delta_e_spectra(light(name, observer), first, second).max())
