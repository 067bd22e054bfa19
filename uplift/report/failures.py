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
    """Failures that a cube records.

    Parameters
    ----------
    counts : dict of str to int
        Lattice points by status.
    over_threshold : int
        Number of lattice points over the threshold.
    worst_points : ndarray of int, shape (k,)
        Indices of the worst of these, worst first.
    improvements : tuple of dict
        Steps of the improvement pass.
    left_out : tuple of str
        Entries outside the RGB space.
    skipped : tuple of str
        Entries that the atlas reader could not use.
    """

    counts: dict[str, int]
    over_threshold: int
    worst_points: Indices
    improvements: tuple[dict[str, Any], ...]
    left_out: tuple[str, ...]
    skipped: tuple[str, ...]


def collect_failures(data: CubeData) -> Failures:
    """Collect the failures that a cube records.

    Parameters
    ----------
    data : CubeData
        The cube.

    Returns
    -------
    Failures
        Counts and names.
    """
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
