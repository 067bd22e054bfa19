"""Points that a sparse cube lacks, taken from another cube: its spectra in the sparse cube's model, exact in colour."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices
from uplift.common.errors import ColourError
from uplift.cube import CubeData, digest
from uplift.lattice import Status
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import refined
from uplift.lookup.nodes import cells
from uplift.lookup.refine import refine_to_rgb
from uplift.models import reflectance

FINITE = 1e-6
"""Nearest to 0 and 1 that a reflectance is taken for where multipliers are sought."""


def missing_points(data: CubeData, rgb: Array | None = None) -> Indices:
    """Numbers of the absent points that linear RGB (n, 3) need; of all of them without."""
    absent = ~data.points.present
    if rgb is not None:
        asked = np.zeros(data.lattice.size, dtype=bool)
        asked[cells(data, rgb)] = True
        absent &= data.lattice.corner_points(asked)
    return np.flatnonzero(absent)


def fill_missing(data: CubeData, points: Indices, other: CubeData, threads: int = 1) -> CubeData:
    """The cube with absent ``points`` (k,) as ``other`` answers at their colours.

    Nobody knows how far those are from measurements: they get the largest standard error that the cube has.
    Raises `ColourError` for cubes of different RGB, or where ``other`` has no answer itself.
    """
    _require_same(data.sensor, other.sensor)
    target, at = data.lattice.target(points), data.sensor.wavelengths
    multipliers = blockwise(partial(_as_other, data, other), target, data.model.count, threads=threads)
    coefficients = data.model.to_storage(multipliers)
    rgb = data.sensor.rgb(reflectance(data.model, coefficients.astype(data.points.coefficients.dtype), at))
    kind = data.points.coefficients.dtype
    if (np.abs(target - rgb) > data.threshold).any():  # single precision is not enough
        kind, rgb = np.dtype(np.float64), data.sensor.rgb(reflectance(data.model, coefficients, at))
    distance = np.abs(target - rgb).max(axis=1)
    status = np.where(distance > data.threshold, Status.UNFITTED, Status.REGULAR)
    put: dict[str, Any] = {"rgb": rgb, "distance": distance, "status": status}
    if data.points.standard_error is not None:
        put["standard_error"] = data.points.standard_error.max()
    changed: dict[str, Any] = {name: getattr(data.points, name).copy() for name in put}
    changed["coefficients"], put["coefficients"] = data.points.coefficients.astype(kind), coefficients
    for name, values in put.items():
        changed[name][points] = values
    told = {**data.provenance, "filled": {"points": len(points), "cube": digest(other)}}
    return replace(data, provenance=told, points=replace(data.points, **changed))


def _as_other(data: CubeData, other: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) of the cube's model: the spectra of ``other`` at linear RGB (n, 3), then the very colour."""
    spectra = refined(other, rgb, data.sensor.wavelengths)
    linear = data.model.unsquash(np.clip(spectra, FINITE, 1 - FINITE))
    start = np.linalg.lstsq(data.model.basis(data.sensor.wavelengths), linear.T, rcond=None)[0].T
    return refine_to_rgb(data, np.ascontiguousarray(start), rgb)


def _require_same(mine: Sensor, its: Sensor) -> None:
    names = [f"{sensor.space} under {sensor.illuminant}, {sensor.observer}" for sensor in (mine, its)]
    if names[0] != names[1]:
        raise ColourError(
            f"a cube in {names[0]} cannot be filled from one in {names[1]}",
            hint="build it with the image in --scene, or without --scene",
        )
