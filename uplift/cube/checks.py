"""Validation of a cube before its first query: shapes, types and ranges of all arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import CubeFileError
from uplift.cube.data import CubeData
from uplift.lattice import Status
from uplift.models import Model

SENSOR_ARRAYS = ("wavelengths", "cmfs", "power", "xyz_to_rgb", "decoding")
SENSITIVITIES = "sensor.sensitivities"
"""Sensitivities of a camera: name in the file."""
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
ENTRY_COEFFICIENTS = "atlas.entry_coefficients"
"""Coefficients of `EntrySpectra`: name in the file."""
LEFT_OUT_ARRAYS = {"measured": "atlas.measured", "answered": "atlas.left_out"}
"""Names in the file by the attributes of `LeftOut`."""
NOT_NEGATIVE = (
    "distance",
    "standard_error",
    "atlas.error",
    "sensor.wavelengths",
    "sensor.power",
    "sensor.decoding",
    SENSITIVITIES,
)
MAX_VALUE = 1e30
"""Limit of all numbers: far above those of any cube, and their squares do not overflow."""
MAX_CONDITION = 1e6
"""Limit of the condition number of the matrix from XYZ to RGB."""

Tensors = Mapping[str, NDArray[Any]]


def check_tensors(
    tensors: Tensors, points: int, coefficients: int, entries: int, entry_coefficients: int, looks: int = 0
) -> None:
    """Check type, shape and range of every array as it is stored, before anything is computed from it.

    Parameters
    ----------
    tensors : mapping of str to ndarray
        Arrays by their names in the file.
    points : int
        Number of points in the file.
    coefficients, entries : int
        Number of coefficients of a node, and of atlas entries.
    entry_coefficients : int
        Number of coefficients of an entry.
    looks : int
        Number of the entries that are looks.

    Raises
    ------
    CubeFileError
        The first condition that is not met, by its code.
    """
    for name, array, shape, types in _arrays(tensors, points, coefficients, entries, entry_coefficients, looks):
        fits = array.shape == shape and array.dtype.name in types
        require(fits, "invalid-array", f"{name} must be {' or '.join(types)} of shape {shape}")
        low = 0 if name in NOT_NEGATIVE else -MAX_VALUE
        problem = f"{name} must have numbers in [{low:g}, {MAX_VALUE:g}]"
        require(_in_range(array, low, MAX_VALUE), "array-not-finite", problem)


def check(data: CubeData) -> None:
    """Check everything else that a lookup relies on.

    Parameters
    ----------
    data : CubeData
        The cube, of arrays that `check_tensors` accepts. The points of a sparse cube are those in its file.

    Raises
    ------
    CubeFileError
        The first condition that is not met, by its code.
    """
    _check_sensor(data)
    _check_entry_model(data.model, data.entry_spectra.model)
    atlas, points = data.atlas, data.points
    recorded = tuple(look["name"] for look in data.provenance.get("looks", ()))
    is_last = atlas.measured_count >= 0 and atlas.names[atlas.measured_count :] == recorded
    require(is_last, "unknown-look", "the looks must be the last entries, by their names")
    require(tuple(data.lattice.nodes[[0, -1]]) == (0, 1), "invalid-nodes", "the nodes must run from 0 to 1")
    require(bool((points.status < len(Status)).all()), "unknown-status", "every status must be known")
    require(bool(points.present.all()), "absent-points-stored", "absent points must not be stored")
    require(_in_range(atlas.half_width, 0, 1), "invalid-entry-boxes", "half widths must be in [0, 1]")
    require(_in_range(atlas.rgb, 0, 1), "entry-out-of-gamut", "the RGB of every entry must be in [0, 1]")
    if atlas.left_out is not None:
        require(atlas.measured_count > 0, "no-entries-left-out", "left-out spectra need entries")
        spectra = (atlas.left_out.measured, atlas.left_out.answered)
        valid = all(_in_range(each, 0, 1) for each in spectra)
        require(valid, "invalid-reflectance", "left-out entries must have reflectances in [0, 1]")
    known = _in_range(points.entry, -1, len(atlas.names) - 1)
    require(known, "unknown-entry", "every entry must be in the atlas table")


def require(condition: bool, code: str, problem: str) -> None:
    """Raise `CubeFileError` unless the condition is met."""
    if not condition:
        raise CubeFileError(problem, code=code)


def _arrays(
    tensors: Tensors, points: int, coefficients: int, entries: int, entry_coefficients: int, looks: int
) -> Iterator[tuple[str, NDArray[Any], tuple[int, ...], tuple[str, ...]]]:
    """Name, array, shape and types of every array but the numbers of the points."""
    samples = tensors["sensor.wavelengths"].size
    columns, double = {"coefficients": (coefficients,), "rgb": (3,)}, ("float64",)
    yield "nodes", tensors["nodes"], (tensors["nodes"].size,), double
    for name, types in POINT_TYPES.items():
        if name in tensors:
            yield name, tensors[name], (points, *columns.get(name, ())), types
    shapes = ((samples,), (samples, 3), (samples,), (3, 3), (256,))
    for name, shape in zip(SENSOR_ARRAYS, shapes, strict=True):
        yield f"sensor.{name}", tensors[f"sensor.{name}"], shape, double
    if SENSITIVITIES in tensors:
        yield SENSITIVITIES, tensors[SENSITIVITIES], (samples, 3), double
    for name in ATLAS_ARRAYS:
        yield f"atlas.{name}", tensors[f"atlas.{name}"], (entries, *columns.get(name, ())), double
    if ENTRY_COEFFICIENTS in tensors:
        yield ENTRY_COEFFICIENTS, tensors[ENTRY_COEFFICIENTS], (entries, entry_coefficients), double
    for name in LEFT_OUT_ARRAYS.values():
        if name in tensors:
            yield name, tensors[name], (entries - looks, samples), ("float32",)


def _check_entry_model(model: Model, entry_model: Model) -> None:
    one, other = ({**each.describe(), "count": None} for each in (model, entry_model))
    extends = one == other and entry_model.count >= model.count
    require(extends, "invalid-entry-model", "the model of the entries must extend that of the nodes")


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
    ascending = bool((np.diff(sensor.wavelengths) > 0).all())
    require(ascending, "sensor-wavelengths", "the wavelengths of the sensor must ascend")
    increasing = bool((np.diff(sensor.decoding) >= 0).all())
    require(increasing, "invalid-decoding", "the decoding of 8-bit codes must not decrease")


def _in_range(array: NDArray[Any], low: float, high: float) -> bool:
    """False for NaN."""
    return bool(((array >= low) & (array <= high)).all())
