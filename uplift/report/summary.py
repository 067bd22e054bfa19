"""The facts of a cube in JSON values: what 'uplift info' tells."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.cube import CubeData, digest


def summary(data: CubeData) -> dict[str, Any]:
    """Plain facts, most general first; distances are max |linear RGB|, standard errors ΔE00 under ``reference``.

    ``points`` are those that are present, of dim³.
    """
    there = data.points.present
    return {
        "model": data.model.describe(),
        "coefficients": data.model.count,
        "dim": data.lattice.dim,
        "points": int(np.count_nonzero(there)),
        "lattice_points": data.lattice.size,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "worst_distance": float(data.points.distance.max()),
        "mean_distance": float(data.points.distance[there].mean(dtype=np.float64)),
        "reference": data.error_illuminant,
        "mean_standard_error": None
        if data.points.standard_error is None
        else float(data.points.standard_error[there].mean(dtype=np.float64)),
        "status": data.points.counts(),
        "entries": list(data.atlas.names),
        "debug": data.points.round is not None,
        "rounds": None if data.points.round is None else int(data.points.round.max()) + 1,
        "provenance": dict(data.provenance),
        "digest": digest(data),
    }
