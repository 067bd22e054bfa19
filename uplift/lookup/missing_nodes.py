"""Nodes that a sparse cube lacks, with the answers of another cube."""

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Indices
from uplift.cube.data import CubeData, common_sensor
from uplift.cube.file import digest
from uplift.lattice.point_table import Status
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import refined
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import reflectance

MIN_REFLECTANCE = 1e-6
"""Reflectances are clipped to this distance from 0 and 1, so that the linear part of
the model is finite.
"""


def fill_missing(
    data: CubeData, points: Indices, other: CubeData, threads: int = 1
) -> CubeData:
    """Return the cube with absent nodes ``points`` (k,) fitted to the answers of
    another cube of the same RGB space.

    Their standard error is the largest of the cube, as their distance from measurements
    is unknown.
    """
    common_sensor([data, other])
    target = data.lattice.target(points)
    table = data.points
    multipliers = blockwise(
        partial(_fit_to_other, data, other), target, data.model.count, threads=threads
    )
    stored = data.model.to_storage(multipliers)
    for values in (stored.astype(table.coefficients.dtype), stored):
        rgb = data.sensor.rgb(reflectance(data.model, values, data.sensor.wavelengths))
        distance = np.abs(target - rgb).max(axis=1)
        if (distance <= data.threshold).all():
            break  # single precision is accurate enough
    status = np.where(distance > data.threshold, Status.UNFITTED, Status.REGULAR)
    rows: dict[str, NDArray[Any]] = {
        "coefficients": values,
        "rgb": rgb,
        "distance": distance,
        "status": status,
    }
    if table.standard_error is not None:
        rows["standard_error"] = np.full(len(points), table.standard_error.max())
    filled = {"points": len(points), "cube": digest(other)}
    provenance = {**data.provenance, "filled": filled}
    return replace(data, provenance=provenance, points=table.filled(points, rows))


def _fit_to_other(data: CubeData, other: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) of the cube's model: close to the spectra of ``other``, with
    exactly the colours (n, 3).
    """
    spectra = refined(other, rgb, data.sensor.wavelengths)
    # min |B p − S⁻¹(g)|, and from this p by steps to the exact colour
    clipped = np.clip(spectra, MIN_REFLECTANCE, 1 - MIN_REFLECTANCE)
    linear = data.model.from_reflectance(clipped)
    basis = data.model.basis(data.sensor.wavelengths)
    start = np.linalg.lstsq(basis, linear.T, rcond=None)[0].T
    return refine_to_rgb(data, data.model, np.ascontiguousarray(start), rgb)
