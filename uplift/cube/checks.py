"""Validation of a cube before its first query: shapes, types and ranges of all arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import CubeFileError
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
"""Types of the arrays of `PointTable`."""
ATLAS_ARRAYS = {"rgb": "rgb", "coefficients": "coefficients", "reach": "half_width", "error": "error"}
"""Attributes of `AtlasTable` by their names in the file."""
MAX_VALUE = 1e30
"""Limit of all numbers: far above those of any cube, and their squares do not overflow."""
MAX_CONDITION = 1e6
"""Limit of the condition number of the matrix from XYZ to RGB."""


def check(data: CubeData, stored: int) -> None:
    """Check everything that a lookup relies on.

    Parameters
    ----------
    data : CubeData
        The cube.
    stored : int
        Number of points in its file.

    Raises
    ------
    CubeFileError
        The first condition that is not met, by its code.
    """
    _check_arrays(data)
    _check_sensor(data)
    atlas, points, sensor = data.atlas, data.points, data.sensor
    texts = (*atlas.names, sensor.space, sensor.illuminant, sensor.observer, data.error_illuminant)
    require(all(isinstance(text, str) for text in texts), "invalid-names", "every name must be text")
    require(isinstance(data.provenance, dict), "invalid-provenance", "the provenance must be a table")
    require(tuple(data.lattice.nodes[[0, -1]]) == (0, 1), "invalid-nodes", "the nodes must run from 0 to 1")
    require(0 < data.threshold < np.inf, "invalid-threshold", "the threshold must be a positive number")
    require(bool((points.status < len(Status)).all()), "unknown-status", "every status must be known")
    present = np.count_nonzero(points.present)
    require(present == stored, "absent-points-stored", "absent points must not be stored")
    complete = data.complete_cells
    require(
        complete is None or bool(complete.any()), "no-complete-cell", "one cell must have all its corners"
    )
    require(_in_range(atlas.half_width, 0, 1), "invalid-entry-boxes", "half widths must be in [0, 1]")
    require(_in_range(atlas.rgb, 0, 1), "entry-out-of-gamut", "the RGB of every entry must be in [0, 1]")
    known = _in_range(points.entry, -1, len(atlas.names) - 1)
    require(known, "unknown-entry", "every entry must be in the atlas table")


def require(condition: bool, code: str, problem: str) -> None:
    """Raise `CubeFileError` unless the condition is met."""
    if not condition:
        raise CubeFileError(problem, code=code)


def _check_arrays(data: CubeData) -> None:
    for name, array, shape, types in _arrays(data):
        fits = array.shape == shape and array.dtype.name in types
        require(fits, "invalid-array", f"{name} must be {' or '.join(types)} of shape {shape}")
        require(_in_range(array, -MAX_VALUE, MAX_VALUE), "array-not-finite", f"{name} must be finite")


def _arrays(data: CubeData) -> Iterator[tuple[str, NDArray[Any], tuple[int, ...], tuple[str, ...]]]:
    """Name, array, shape and types of every array of the cube."""
    points, count, entries = data.lattice.size, data.model.count, len(data.atlas.names)
    samples = len(data.sensor.wavelengths)
    double = ("float64",)
    yield "nodes", data.lattice.nodes, (data.lattice.dim,), double
    columns = {"coefficients": (count,), "rgb": (3,)}
    for name, types in POINT_TYPES.items():
        array = getattr(data.points, name)
        if array is not None:
            yield name, array, (points, *columns.get(name, ())), types
    shapes = ((samples,), (samples, 3), (samples,), (3, 3), (256,))
    for name, shape in zip(SENSOR_ARRAYS, shapes, strict=True):
        yield f"sensor.{name}", getattr(data.sensor, name), shape, double
    for name, attribute in ATLAS_ARRAYS.items():
        yield f"atlas.{name}", getattr(data.atlas, attribute), (entries, *columns.get(name, ())), double


def _check_sensor(data: CubeData) -> None:
    sensor, count = data.sensor, data.model.count
    with np.errstate(all="ignore"):
        basis = data.model.basis(sensor.wavelengths)
        white, condition = sensor.matrix.sum(axis=1), np.linalg.cond(sensor.xyz_to_rgb)
    valid = basis.shape == (len(sensor.wavelengths), count) and bool(np.isfinite(basis).all())
    require(valid, "invalid-model-range", "the model must have a range of wavelengths")
    is_white = _in_range(white, 1 - 1e-6, 1 + 1e-6)
    require(is_white, "invalid-white", "the perfect reflector must have RGB (1, 1, 1)")
    require(bool(condition < MAX_CONDITION), "invalid-primaries", "the RGB space must have three primaries")
    increasing = bool((np.diff(sensor.decoding) >= 0).all())
    require(increasing, "invalid-decoding", "the decoding of 8-bit codes must not decrease")


def _in_range(array: NDArray[Any], low: float, high: float) -> bool:
    """False for NaN."""
    return bool(((array >= low) & (array <= high)).all())
