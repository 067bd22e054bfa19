"""Fill missing points of a sparse cube with the spectra of another cube, fitted by the sparse cube's model."""

from dataclasses import fields, replace
from functools import partial
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.common.errors import ColourError
from uplift.cube import CubeData, digest
from uplift.lattice import Status
from uplift.lattice.point_table import ABSENT_VALUES, PointTable
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import cells, refined
from uplift.lookup.refine import refine_to_rgb
from uplift.models import reflectance

MIN_REFLECTANCE = 1e-6
"""Reflectances are clipped to this distance from 0 and 1, so that the linear part of the model is finite."""


def missing_points(data: CubeData, rgb: Array | None = None) -> Indices:
    """Return the absent points that linear RGB (n, 3) need, or all absent points."""
    absent = ~data.points.present
    if rgb is not None:
        absent &= data.lattice.corner_points(data.lattice.mask(cells(data, rgb)))
    return np.flatnonzero(absent)


def fill_missing(data: CubeData, points: Indices, other: CubeData, threads: int = 1) -> CubeData:
    """Return the cube with absent ``points`` (k,) filled by the answers of another cube of the same RGB space.

    Their standard error is the largest of the cube, as their distance from measurements is unknown.
    """
    spaces = [f"{each.space} under {each.illuminant}, {each.observer}" for each in (data.sensor, other.sensor)]
    if spaces[0] != spaces[1]:
        raise ColourError(
            f"a cube can only be filled from one of the same RGB space: {spaces[0]}, got {spaces[1]}",
            code="cubes-of-different-spaces",
            hint="build the cube with all colours in its scene, or without a scene",
        )
    target, table = data.lattice.target(points), data.points
    multipliers = blockwise(partial(_fit_to_other, data, other), target, data.model.count, threads=threads)
    coefficients, kind = data.model.to_storage(multipliers), table.coefficients.dtype
    rgb = _rgb(data, coefficients.astype(kind))
    if (np.abs(target - rgb) > data.threshold).any():  # single precision is not accurate enough
        kind, rgb = np.dtype(np.float64), _rgb(data, coefficients)
    distance = np.abs(target - rgb).max(axis=1)
    status = np.where(distance > data.threshold, Status.UNFITTED, Status.REGULAR)
    filled: dict[str, Any] = {"coefficients": coefficients, "rgb": rgb, "distance": distance, "status": status}
    if table.standard_error is not None:
        filled["standard_error"] = np.full(len(points), table.standard_error.max())
    present = np.flatnonzero(table.present)  # the others take no memory
    rows: dict[str, Any] = {}
    for each in fields(table):
        column = getattr(table, each.name)
        if column is not None:
            values = filled.get(each.name, np.full(len(points), ABSENT_VALUES.get(each.name, 0)))
            dtype = kind if each.name == "coefficients" else column.dtype
            rows[each.name] = np.concatenate([column[present], values]).astype(dtype)
    complete = PointTable(**rows).spread(np.concatenate([present, points]), data.lattice.size)
    provenance = {**data.provenance, "filled": {"points": len(points), "cube": digest(other)}}
    return replace(data, provenance=provenance, points=complete)


def _rgb(data: CubeData, coefficients: Array) -> Array:
    return data.sensor.rgb(reflectance(data.model, coefficients, data.sensor.wavelengths))


def _fit_to_other(data: CubeData, other: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) of the cube's model: close to the spectra of ``other``, with exactly the colours (n, 3)."""
    spectra = refined(other, rgb, data.sensor.wavelengths)
    # min |B p − S⁻¹(g)|, and from this p by steps to the exact colour
    linear = data.model.from_reflectance(np.clip(spectra, MIN_REFLECTANCE, 1 - MIN_REFLECTANCE))
    start = np.linalg.lstsq(data.model.basis(data.sensor.wavelengths), linear.T, rcond=None)[0].T
    return refine_to_rgb(data, data.model, np.ascontiguousarray(start), rgb)
