"""Facts about a cube, as ``uplift info`` and reports list them."""

from typing import Any

import numpy as np

from uplift.cube.data import CubeData
from uplift.cube.file import digest


def summarise(data: CubeData) -> dict[str, Any]:
    """Summarise a cube, most general facts first."""
    points = data.points
    present, errors = points.present, points.standard_error
    return {
        "model": data.model.describe(),
        "coefficients": data.model.count,
        "entry_coefficients": data.entry_spectra.model.count,
        "dim": data.lattice.dim,
        "points": int(np.count_nonzero(present)),
        "lattice_points": data.lattice.size,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "worst_distance": float(points.distance.max()),
        "mean_distance": float(points.distance[present].mean(dtype=np.float64)),
        "reference": data.error_illuminant,
        "mean_standard_error": None if errors is None else float(errors[present].mean(dtype=np.float64)),
        "status": points.counts(),
        "entries": list(data.atlas.names),
        "outside": [] if data.atlas.outside is None else list(data.atlas.outside.names),
        "debug": points.round is not None,
        "rounds": None if points.round is None else int(points.round.max()) + 1,
        "provenance": dict(data.provenance),
        "digest": digest(data),
    }
