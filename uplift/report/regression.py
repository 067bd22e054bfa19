"""Comparison of a stored cube with a rebuilt one: whether this version reproduces stored cubes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import REGRESSION_LIGHTS
from uplift.colorimetry.observer import light
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array, Mask
from uplift.common.errors import CubeFileError
from uplift.cube import CubeData
from uplift.lattice import Status
from uplift.models import reflectance

# Largest differences allowed between machines: at least thirty times the effect of other instruction sets
# (docs/data/stability-determinism.json). On one machine there are none, for any number of threads.
LIMITS = {"rgb": 1e-6, "spectra_max": 1e-5, "spectra_rms": 1e-7} | {
    f"delta_e_{name}": 1e-4 for name in REGRESSION_LIGHTS
}
# Largest difference of lattice nodes. They are the same on every CPU since version 0.2. Cubes of earlier versions have
# the powers of numpy, which instruction sets round differently.
NODE_TOLERANCE = 1e-12
# Linear RGB within the object-colour solid. Points of wide gamuts nearer to its boundary have spectra close to box
# functions, and many of these meet the colour equally well: rounding decides between them.
BOUNDARY_MARGIN = 1e-3


@dataclass(frozen=True)
class RebuildDifference:
    """Differences between a stored cube and a rebuilt one."""

    path: Path  # File of the stored cube
    # Largest differences by the names in `LIMITS`, over the entries and the points whose spectra are well
    # determined
    measures: dict[str, float]
    stored_counts: dict[str, int]  # Number of these points by status, and of all unfitted points
    rebuilt_counts: dict[str, int]  # Number of these points by status, and of all unfitted points

    @property
    def failures(self) -> tuple[str, ...]:
        """Return the measures over their limits or NaN, and ``status`` if the counts differ."""
        over = [name for name, value in self.measures.items() if not value <= LIMITS[name]]
        return (*over, *(["status"] if self.stored_counts != self.rebuilt_counts else []))


def compare_rebuilt(path: Path, stored: CubeData, rebuilt: CubeData) -> RebuildDifference:
    """Compare a stored cube with a rebuilt one."""
    if not _same_lattice(stored, rebuilt):
        raise CubeFileError(
            "its lattice is not the one that its options give",
            code="lattice-mismatch",
            path=path,
            hint="build the cube again",
        )
    if stored.atlas.names != rebuilt.atlas.names:
        raise CubeFileError(
            "its entries are not those that its atlas gives",
            code="entries-mismatch",
            path=path,
            hint="build the cube again",
        )
    compared = _well_determined(stored) & (stored.points.present | rebuilt.points.present)
    first, second = (_spectra(data, compared) for data in (stored, rebuilt))
    difference = np.abs(first - second)
    measures = {
        "rgb": float(np.abs(stored.points.rgb.astype(float) - rebuilt.points.rgb)[compared].max()),
        "spectra_max": float(difference.max()),
        "spectra_rms": float(np.sqrt((difference**2).mean())),
    }
    for name in REGRESSION_LIGHTS:
        measures[f"delta_e_{name}"] = _largest_delta_e(name, stored.sensor, first, second)
    return RebuildDifference(path, measures, _counts(stored, compared), _counts(rebuilt, compared))


def _same_lattice(stored: CubeData, rebuilt: CubeData) -> bool:
    nodes, other = stored.lattice.nodes, rebuilt.lattice.nodes
    return nodes.shape == other.shape and bool((np.abs(nodes - other) <= NODE_TOLERANCE).all())


def _spectra(data: CubeData, points: Mask) -> Array:
    """Reflectance (k, N) of lattice points (n,) and of all entries."""
    wavelengths = data.sensor.wavelengths
    lattice = reflectance(data.model, data.points.coefficients[points], wavelengths)
    entries = np.arange(len(data.atlas.names))
    return np.concatenate([lattice, data.entry_spectra.reflectance(entries, wavelengths)])


def _well_determined(data: CubeData) -> Mask:
    """Points (n,) whose spectra do not depend on the machine: all, if the space has no unrealisable points."""
    if Status.UNREALISABLE not in data.points.status:
        return np.ones(data.lattice.size, dtype=bool)
    return np.asarray(solid(data.sensor.matrix).signed_distance(data.lattice.points) < -BOUNDARY_MARGIN)


def _counts(data: CubeData, compared: Mask) -> dict[str, int]:
    counts = replace(data.points, status=data.points.status[compared]).counts()
    return counts | {Status.UNFITTED.label: int((data.points.status == Status.UNFITTED).sum())}


def _largest_delta_e(name: str, sensor: Sensor, first: Array, second: Array) -> float:
    return float(delta_e_spectra(light(name, sensor.observer, *sensor.range), first, second).max())
