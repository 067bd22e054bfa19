"""Facts about a cube or an emission table as JSON values."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.cube import CubeData, digest
from uplift.lights.table import KIND, EmissionData, emission_digest


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
        "debug": points.round is not None,
        "rounds": None if points.round is None else int(points.round.max()) + 1,
        "provenance": dict(data.provenance),
        "digest": digest(data),
    }


def summarise_emission(data: EmissionData) -> dict[str, Any]:
    """Summarise an emission table, most general facts first."""
    knots, rings = data.lattice.shape
    first, second = data.wavelengths[:2].tolist()
    return {
        "format": KIND.format,
        "knots": knots,
        "rings": rings,
        "nodes": knots * rings,
        "space": data.space,
        "observer": data.observer,
        "wavelengths": {"first": first, "last": float(data.wavelengths[-1]), "step": second - first},
        "mean_expected_error": float(data.error.mean(dtype=np.float64)),
        "largest_expected_error": float(data.error.max()),
        "lamps": list(data.entries.names),
        "provenance": dict(data.provenance),
        "digest": emission_digest(data),
    }
