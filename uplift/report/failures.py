"""What went wrong in a cube: points over the threshold, steps that mended some, entries that are not in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Indices
from uplift.cube import CubeData
from uplift.lattice import Status

NAMED = 24
"""Points over the threshold that are named, worst first."""


@dataclass(frozen=True, eq=False)
class Failures:
    """``missed`` lattice points over the threshold; the worst of them in ``points`` (k,), by number.

    ``improvements`` are the steps of the improvement pass, ``left_out`` the entries outside the space,
    ``skipped`` those that the atlas reader could not use.
    """

    counts: dict[str, int]
    missed: int
    points: Indices
    improvements: tuple[dict[str, Any], ...]
    left_out: tuple[str, ...]
    skipped: tuple[str, ...]


def failures(data: CubeData) -> Failures:
    """What a cube has recorded of its failures."""
    failed = np.isin(data.points.status, (Status.UNFITTED, Status.UNREALISABLE))
    rows = np.flatnonzero(failed | ~(data.points.distance <= data.threshold))
    worst = rows[np.argsort(-data.points.distance[rows], kind="stable")][:NAMED]
    recorded = data.provenance
    return Failures(
        counts=data.points.counts(),
        missed=len(rows),
        points=worst,
        improvements=tuple(recorded.get("improvements", ())),
        left_out=tuple(recorded.get("left_out", ())),
        skipped=tuple(recorded.get("skipped", ())),
    )
