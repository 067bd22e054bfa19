"""What a cube file must hold: the arrays, and what is true of them."""

from __future__ import annotations

from typing import Any

import numpy as np

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
FEATURES = {"debug": "round", "errors": "standard_error"}
"""Arrays that a cube may have or not, by the feature that says so."""
ATLAS_ARRAYS = ("rgb", "coefficients", "reach", "error")


def check(data: CubeData, stored: int) -> None:
    """Shapes, types and ranges that a lookup relies on, of a cube with ``stored`` points in its file.

    Raises `ValueError`.
    """
    points, count, samples = data.lattice.size, data.model.count, len(data.sensor.wavelengths)
    entries = len(data.atlas.names)
    shapes = {"coefficients": (points, count), "rgb": (points, 3)}
    for name, kinds in POINT_TYPES.items():
        array = getattr(data, name)
        fits = array is None or (array.shape == shapes.get(name, (points,)) and array.dtype.name in kinds)
        _require(fits, f"{name} has its shape")
    sensor_shapes = ((samples,), (samples, 3), (samples,), (3, 3), (256,))
    for name, shape in zip(SENSOR_ARRAYS, sensor_shapes, strict=True):
        _require(getattr(data.sensor, name).shape == shape, f"the sensor's {name} has its shape")
    atlas_shapes = ((entries, 3), (entries, count), (entries,), (entries,))
    for name, shape in zip(ATLAS_ARRAYS, atlas_shapes, strict=True):
        _require(getattr(data.atlas, name).shape == shape, f"every entry has its {name}")
    sensor_names = (data.sensor.space, data.sensor.illuminant, data.sensor.observer)
    texts = (*data.atlas.names, *sensor_names, data.reference)
    _require(all(isinstance(text, str) for text in texts), "every name is a text")
    _require(isinstance(data.provenance, dict), "the provenance is a table")
    floats: list[Any] = [data.coefficients, data.rgb, data.distance]
    floats += [] if data.standard_error is None else [data.standard_error]
    floats += [getattr(data.atlas, name) for name in ATLAS_ARRAYS]
    floats += [getattr(data.sensor, name) for name in SENSOR_ARRAYS]
    _require(all(np.isfinite(array).all() for array in floats), "every number is finite")
    with np.errstate(all="ignore"):
        basis = data.model.basis(data.sensor.wavelengths)
    _require(basis.shape == (samples, count) and bool(np.isfinite(basis).all()), "the model has a range")
    _require(tuple(data.lattice.nodes[[0, -1]]) == (0, 1), "the lattice runs from 0 to 1")
    _require(0 < data.threshold < np.inf, "the threshold is a positive number")
    _require(bool((data.status < len(Status)).all()), "every status is known")
    reaches = bool(((data.atlas.reach >= 0) & (data.atlas.reach <= 1)).all())
    _require(reaches, "no entry reaches further than a step")
    _require(bool(((data.entry >= -1) & (data.entry < entries)).all()), "every entry is in the atlas table")
    present = np.count_nonzero(data.present)
    _require(present == stored, "absent points are those that are not stored")
    _require(data.complete is None or bool(data.complete.any()), "a cell has all its corners")


def _require(holds: bool, law: str) -> None:
    if not holds:
        raise ValueError(f"it does not hold that {law}")
