"""What a cube must hold before anything is asked of it: whole arrays, a sensor that sees, numbers to reckon with."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.cube.data import CubeData
from uplift.lattice import Status

SENSOR_ARRAYS = ("wavelengths", "cmfs", "power", "xyz_to_rgb", "decoding")
POINT_TYPES: dict[str, tuple[str, ...]] = {
    "coefficients": ("float32", "float64"),
    "rgb": ("float32",),
    "distance": ("float32",),
    "status": ("uint8",),
    "entry": ("int32",),
    "round": ("int16",),
    "standard_error": ("float32",),
}
LARGEST = 1e30
"""No number of a cube comes near it, and squares of it can still be reckoned with."""
WORST_CONDITION = 1e6
ATLAS_ARRAYS = {"rgb": "rgb", "coefficients": "coefficients", "reach": "half_width", "error": "error"}
"""Attributes of `AtlasTable` by their names in the file."""


def check(data: CubeData, stored: int) -> None:
    """Shapes, types and ranges that a lookup relies on, of a cube with ``stored`` points in its file.

    Raises ValueError for what does not hold.
    """
    _check_arrays(data)
    _check_sensor(data)
    sensor_names = (data.sensor.space, data.sensor.illuminant, data.sensor.observer)
    texts = (*data.atlas.names, *sensor_names, data.error_illuminant)
    _require(all(isinstance(text, str) for text in texts), "every name is a text")
    _require(isinstance(data.provenance, dict), "the provenance is a table")
    _require(tuple(data.lattice.nodes[[0, -1]]) == (0, 1), "the lattice runs from 0 to 1")
    _require(0 < data.threshold < np.inf, "the threshold is a positive number")
    _require(bool((data.points.status < len(Status)).all()), "every status is known")
    present = np.count_nonzero(data.points.present)
    _require(present == stored, "absent points are those that are not stored")
    _require(data.complete_cells is None or bool(data.complete_cells.any()), "a cell has all its corners")
    atlas = data.atlas
    _require(_within(atlas.half_width, 0, 1), "no entry reaches further than a step")
    _require(_within(atlas.rgb, 0, 1), "every entry lies within the space")
    _require(_within(data.points.entry, -1, len(atlas.names) - 1), "every entry is in the atlas table")


def _check_arrays(data: CubeData) -> None:
    points, count, samples = data.lattice.size, data.model.count, len(data.sensor.wavelengths)
    entries = len(data.atlas.names)
    shapes: dict[str, tuple[int, ...]] = {"coefficients": (points, count), "rgb": (points, 3)}
    arrays: list[tuple[str, Any, tuple[int, ...]]] = [
        (name, getattr(data.points, name), shapes.get(name, (points,))) for name in POINT_TYPES
    ]
    sensor_shapes = ((samples,), (samples, 3), (samples,), (3, 3), (256,))
    arrays += [
        (f"the sensor's {name}", getattr(data.sensor, name), shape)
        for name, shape in zip(SENSOR_ARRAYS, sensor_shapes, strict=True)
    ]
    atlas_shapes = ((entries, 3), (entries, count), (entries,), (entries,))
    arrays += [
        (f"every entry's {name}", getattr(data.atlas, attribute), shape)
        for (name, attribute), shape in zip(ATLAS_ARRAYS.items(), atlas_shapes, strict=True)
    ]
    for name, array, shape in [*arrays, ("nodes", data.lattice.nodes, (data.lattice.dim,))]:
        if array is not None:
            fits = array.shape == shape and array.dtype.name in POINT_TYPES.get(name, ("float64",))
            _require(fits, f"{name} has its shape")
            _require(_within(array, -LARGEST, LARGEST), "every number is finite")


def _check_sensor(data: CubeData) -> None:
    sensor, count = data.sensor, data.model.count
    with np.errstate(all="ignore"):
        basis = data.model.basis(sensor.wavelengths)
        white, condition = sensor.matrix.sum(axis=1), np.linalg.cond(sensor.xyz_to_rgb)
    known = basis.shape == (len(sensor.wavelengths), count) and np.isfinite(basis).all()
    _require(bool(known), "the model has a range")
    _require(_within(white, 1 - 1e-6, 1 + 1e-6), "the perfect reflector is white")
    _require(bool(condition < WORST_CONDITION), "the RGB space has three primaries")
    _require(bool((np.diff(sensor.decoding) >= 0).all()), "larger codes are lighter")


def _within(array: NDArray[Any], low: float, high: float) -> bool:
    """NaN is not."""
    return bool(((array >= low) & (array <= high)).all())


def _require(holds: bool, law: str) -> None:
    if not holds:
        raise ValueError(f"it does not hold that {law}")
