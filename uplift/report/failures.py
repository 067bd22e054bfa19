"""Failures of a build: points over the threshold, the steps that improved some, entries not in the cube."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Indices
from uplift.cube import CubeData
from uplift.lattice import Status

MAX_LISTED = 24
"""Points over the threshold that a report lists."""


@dataclass(frozen=True, eq=False)
class Failures:
    """Failures that a cube records."""

    counts: dict[str, int]  # Lattice points by status
    over_threshold: int  # Number of lattice points over the threshold
    worst_points: Indices  # (k,) Indices of the worst of these, worst first
    improvements: tuple[dict[str, Any], ...]  # Steps of the improvement pass
    left_out: tuple[str, ...]  # Entries outside the RGB space
    skipped: tuple[str, ...]  # Entries that the atlas reader could not use


def collect_failures(data: CubeData) -> Failures:
    """Collect the failures that a cube records."""
    points, recorded = data.points, data.provenance
    failed = np.isin(points.status, (Status.UNFITTED, Status.UNREALISABLE))
    rows = np.flatnonzero(failed | ~(points.distance <= data.threshold))
    return Failures(
        counts=points.counts(),
        over_threshold=len(rows),
        worst_points=rows[np.argsort(-points.distance[rows], kind="stable")][:MAX_LISTED],
        improvements=tuple(recorded.get("improvements", ())),
        left_out=tuple(recorded.get("left_out", ())),
        skipped=tuple(recorded.get("skipped", ())),
    )
