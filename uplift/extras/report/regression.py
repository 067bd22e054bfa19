"""Comparison of a stored cube with a rebuilt one: whether this version reproduces
stored cubes.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

import numpy as np

from uplift.colorimetry.object_colours import solid
from uplift.colorimetry.observer import lights
from uplift.common.arrays import Mask
from uplift.common.errors import CubeFileError
from uplift.cube.data import CubeData
from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
from uplift.extras.report.comparison import compare_spectra
from uplift.extras.report.diff import pair_entries
from uplift.lattice.point_table import Status
from uplift.models.model import reflectance

# Largest differences allowed between machines: at least thirty times the effect of
# other instruction sets (docs/data/determinism.json). On one machine there
# are none, for any number of threads.
LIMITS = {"rgb": 1e-6, "spectra_max": 1e-5, "spectra_rms": 1e-7} | {
    f"delta_e_{name}": 1e-4 for name in REGRESSION_LIGHTS
}
MOVED = LIMITS[f"delta_e_{REGRESSION_LIGHTS[0]}"]
# Largest difference of nodes. They are the same on every CPU since version 0.2. Cubes
# of earlier versions have the powers of numpy, which instruction sets round
# differently.
NODE_TOLERANCE = 1e-12
# Linear RGB within the object-colour solid. Nodes of wide gamuts nearer to its boundary
# have spectra close to box functions, and many of these meet the colour equally well:
# rounding decides between them.
BOUNDARY_MARGIN = 1e-3


@dataclass(frozen=True)
class EntryChange:
    """An atlas entry that was removed, added, or moved: by the largest ΔE00 under
    `REGRESSION_LIGHTS`.
    """

    name: str
    change: Literal["removed", "added", "moved"]
    delta_e: float | None = None


@dataclass(frozen=True)
class RebuildDifference:
    """Differences between a stored cube and a rebuilt one."""

    measures: dict[str, float] = field(default_factory=dict)
    """Largest differences by the names in `LIMITS`, over the entries and the nodes
    whose spectra are well determined.
    """
    status: dict[str, dict[str, int]] = field(default_factory=dict)
    """Number of these nodes by status, and of all unfitted nodes, of the cube that is
    ``stored`` and of the one that is ``rebuilt``.
    """
    entries: tuple[EntryChange, ...] = ()
    """Entries that differ."""

    @property
    def failures(self) -> list[str]:
        """Return the measures over their limits or NaN, ``status`` if the counts
        differ, and ``entries`` likewise.
        """
        failures = [
            name for name, value in self.measures.items() if not value <= LIMITS[name]
        ]
        if self.status and self.status["stored"] != self.status["rebuilt"]:
            failures.append("status")
        if self.entries:
            failures.append("entries")
        return failures


def compare_rebuilt(
    path: Path, stored: CubeData, rebuilt: CubeData
) -> RebuildDifference:
    """Compare a stored cube with a rebuilt one."""
    nodes = stored.lattice.nodes
    other = rebuilt.lattice.nodes
    if nodes.shape != other.shape or (np.abs(nodes - other) > NODE_TOLERANCE).any():
        raise CubeFileError(
            "its lattice is not the one of its options",
            path=path,
            hint="build the cube again",
        )
    compared = _well_determined(stored) & (
        stored.points.present | rebuilt.points.present
    )
    pairs = pair_entries(stored, rebuilt)
    wavelengths = stored.sensor.wavelengths
    spectra = []
    for data, entries in zip((stored, rebuilt), pairs.spectra, strict=True):
        coefficients = data.points.coefficients[compared]
        nodes = reflectance(data.model, coefficients, wavelengths)
        spectra.append(np.concatenate([nodes, entries]))
    setting = stored.sensor.observer, stored.sensor.range
    before, after = spectra
    found = compare_spectra(after, before, lights(REGRESSION_LIGHTS, *setting))
    rgb = np.abs(stored.points.rgb.astype(float) - rebuilt.points.rgb)[compared]
    measures = {
        "rgb": float(rgb.max(initial=0)),
        "spectra_max": float(found.deviation.max(initial=0)),
        "spectra_rms": float(np.sqrt(((before - after) ** 2).mean())),
    }
    largest = found.delta_e.max(axis=0, initial=0).tolist()
    for name, value in zip(found.lights, largest, strict=True):
        measures[f"delta_e_{name}"] = value
    moved = found.worst[np.count_nonzero(compared) :]
    # Cubes of earlier versions have the names of entries outside their RGB space only.
    old = stored.provenance.get("left_out", ())
    new = rebuilt.provenance.get("left_out", ())
    changes = [
        EntryChange(name, "removed") for name in pairs.removed if name not in new
    ]
    changes += [EntryChange(name, "added") for name in pairs.added if name not in old]
    changes += [
        EntryChange(pairs.names[row], "moved", float(moved[row]))
        for row in np.flatnonzero(moved > MOVED)
    ]
    status = {
        "stored": _counts(stored, compared),
        "rebuilt": _counts(rebuilt, compared),
    }
    return RebuildDifference(measures, status, tuple(changes))


def _well_determined(data: CubeData) -> Mask:
    """Nodes (n,) whose spectra do not depend on the machine: all, if the space has no
    unrealisable nodes.

    The smallest lattices have only nodes on the boundary of realisable colours: those
    that were fitted are compared.
    """
    unrealisable = data.points.status == Status.UNREALISABLE
    if not unrealisable.any():
        return np.ones(data.lattice.size, dtype=bool)
    inside = (
        solid(data.sensor.matrix).signed_distance(data.lattice.points)
        < -BOUNDARY_MARGIN
    )
    return inside if inside.any() else ~unrealisable


def _counts(data: CubeData, compared: Mask) -> dict[str, int]:
    counts = replace(data.points, status=data.points.status[compared]).counts()
    return counts | {
        Status.UNFITTED.label: int((data.points.status == Status.UNFITTED).sum())
    }
