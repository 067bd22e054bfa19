"""Read and write cube files (docs/cube-file.md)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Indices
from uplift.cube.container import (
    Kind,
    Stored,
    Tensors,
    check_arrays,
    content_digest,
    in_range,
    load,
    replace_file,
    require,
    validation,
)
from uplift.cube.data import AtlasTable, CubeData, EntrySpectra, LeftOut
from uplift.cube.metadata import METADATA, check_metadata
from uplift.lattice import ABSENT_VALUES, CORNERS, Lattice, PointTable, Status
from uplift.models import Model, from_description

FORMAT = "uplift cube"
VERSION = 4
KIND = Kind(FORMAT, (3, VERSION), "cube", "not-a-cube")
"""Versions that are read. The entries of version 3 have as many coefficients as the nodes."""
FEATURES = ("debug", "errors", "left-out", "camera", "sparse")
"""Optional parts of a file, in the order in which the metadata list them."""
MAX_POINTS = 1 << 27
"""Points of the largest lattice of a sparse file, as a small file must not claim all memory."""
MAX_CONDITION = 1e6
"""Limit of the condition number of the matrix from XYZ to RGB."""

SINGLE = ("float32",)
POINTS = {
    "coefficients": Stored("n C", ("float32", "float64")),
    "rgb": Stored("n 3", SINGLE),
    "distance": Stored("n", SINGLE, low=0),
    "status": Stored("n", ("uint8",)),
    "entry": Stored("n", ("int32",)),
    "round": Stored("n", ("int16",), feature="debug"),
    "standard_error": Stored("n", SINGLE, low=0, feature="errors"),
}
"""Arrays of the `PointTable`. Sparse files have rows of the present points only."""
SENSOR = {
    "wavelengths": Stored("N", low=0),
    "cmfs": Stored("N 3"),
    "power": Stored("N", low=0),
    "xyz_to_rgb": Stored("3 3"),
    "decoding": Stored("256", low=0),
    "sensitivities": Stored("N 3", low=0, feature="camera"),
}
ENTRY_COEFFICIENTS = "atlas.entry_coefficients"
ARRAYS = {
    "nodes": Stored("D"),
    "points": Stored("n", ("uint32",), feature="sparse"),
    **POINTS,
    **{f"sensor.{name}": stored for name, stored in SENSOR.items()},
    "atlas.rgb": Stored("E 3"),
    "atlas.coefficients": Stored("E C"),
    "atlas.reach": Stored("E"),
    "atlas.error": Stored("E", low=0),
    ENTRY_COEFFICIENTS: Stored("E K"),
    "atlas.measured": Stored("M N", SINGLE, feature="left-out"),
    "atlas.left_out": Stored("M N", SINGLE, feature="left-out"),
}
"""All arrays of a file by name. Letters as in docs/cube-file.md, and D for the number of nodes along an axis."""


def write(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a cube file, atomically. The new file is read back before it replaces an existing one."""
    replace_file(contents(data), path, KIND, read, force=force)


def read(path: str | os.PathLike[str]) -> CubeData:
    """Read a cube file. A file that is missing, damaged, of another kind or invalid is a `CubeFileError`."""
    path = Path(path)
    # Format, version and digest. All that follows is for files whose digest was forged.
    tensors, metadata = load(path, KIND)
    with validation(path, KIND):
        if metadata["version"] < VERSION:
            metadata["entry_model"] = metadata.get("model")
        # Types and ranges of metadata, then of arrays, before anything is computed from them.
        check_metadata(metadata, METADATA)
        data = _data(tensors, metadata)
        _check(data)
        if "sparse" in metadata["features"]:
            data = replace(data, points=_expand(data.points, tensors["points"], data.lattice))
        size = data.lattice.size
        require(len(data.points) == size, f"there must be {size} points, got {len(data.points)}")
    return data


def digest(data: CubeData) -> str:
    """Compute the SHA-256 of a cube, in hexadecimal. Cubes with equal digests give equal answers, bit for bit."""
    return content_digest(*contents(data))


def contents(data: CubeData) -> tuple[Tensors, dict[str, Any]]:
    """Return the arrays by their names in the file, and the metadata without the digest."""
    atlas = data.atlas
    spectra = None if atlas.spectra is None else atlas.spectra.coefficients
    measured, answered = (None, None) if atlas.left_out is None else (atlas.left_out.measured, atlas.left_out.answered)
    arrays = {
        "nodes": data.lattice.nodes,
        **{f"sensor.{name}": getattr(data.sensor, name) for name in SENSOR},
        "atlas.rgb": atlas.rgb,
        "atlas.coefficients": atlas.coefficients,
        "atlas.reach": atlas.half_width,
        "atlas.error": atlas.error,
        ENTRY_COEFFICIENTS: spectra,
        "atlas.measured": measured,
        "atlas.left_out": answered,
        **{name: getattr(data.points, name) for name in POINTS},
    }
    tensors = {name: _as_stored(name, array) for name, array in arrays.items() if array is not None}
    if data.complete_cells is not None:
        present = data.points.present
        tensors |= {name: np.ascontiguousarray(tensors[name][present]) for name in POINTS if name in tensors}
        tensors["points"] = np.flatnonzero(present).astype(np.uint32)
    announced = {ARRAYS[name].feature for name in tensors}
    metadata = {
        "format": FORMAT,
        "version": VERSION,
        "features": [feature for feature in FEATURES if feature in announced],
        "model": data.model.describe(),
        "entry_model": data.entry_spectra.model.describe(),
        "dim": data.lattice.dim,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "reference": data.error_illuminant,
        "entries": list(atlas.names),
        "provenance": dict(data.provenance),
    }
    return tensors, metadata


def _as_stored(name: str, array: NDArray[Any]) -> NDArray[Any]:
    """Return an array of a type that its file may have: its own, or else the most precise one."""
    types = ARRAYS[name].types
    return np.ascontiguousarray(array, dtype=array.dtype if array.dtype.name in types else types[-1])


def _data(tensors: Tensors, metadata: Mapping[str, Any]) -> CubeData:
    """Content of a file; the points of a sparse cube are not expanded."""
    model, entry_model = (from_description(metadata[key]) for key in ("model", "entry_model"))
    names, looks = tuple(metadata["entries"]), len(metadata["provenance"].get("looks", ()))
    schema = {name: stored for name, stored in ARRAYS.items() if stored.feature in ("", *metadata["features"])}
    if entry_model == model:
        del schema[ENTRY_COEFFICIENTS]
    sizes = {"C": model.count, "K": entry_model.count, "E": len(names), "M": len(names) - looks}
    for axis, name in (("D", "nodes"), ("n", "status"), ("N", "sensor.wavelengths")):
        sizes[axis] = tensors[name].size
    check_arrays(tensors, schema, sizes)
    arrays: dict[str, Any] = {name: tensors[name] for name in schema}
    has_left_out = "atlas.measured" in arrays
    lattice = Lattice(tensors["nodes"])
    require(metadata["dim"] == lattice.dim, f"dim must be {lattice.dim}, the number of nodes")
    return CubeData(
        model=model,
        lattice=lattice,
        sensor=Sensor(
            metadata["space"],
            metadata["illuminant"],
            metadata["observer"],
            **{name: arrays[f"sensor.{name}"] for name in SENSOR if f"sensor.{name}" in arrays},
        ),
        threshold=float(metadata["threshold"]),
        error_illuminant=metadata["reference"],
        atlas=AtlasTable(
            names,
            rgb=arrays["atlas.rgb"],
            coefficients=arrays["atlas.coefficients"],
            half_width=arrays["atlas.reach"],
            error=arrays["atlas.error"],
            spectra=None if entry_model == model else EntrySpectra(entry_model, arrays[ENTRY_COEFFICIENTS]),
            left_out=LeftOut(arrays["atlas.measured"], arrays["atlas.left_out"]) if has_left_out else None,
            looks=looks,
        ),
        provenance=metadata["provenance"],
        points=PointTable(**{name: arrays[name] for name in POINTS if name in arrays}),
    )


def _check(data: CubeData) -> None:
    """Check what a lookup relies on beyond types and ranges. The points of a sparse cube are those in its file."""
    _check_sensor(data)
    _check_models(data.model, data.entry_spectra.model)
    atlas, points = data.atlas, data.points
    recorded = tuple(look["name"] for look in data.provenance.get("looks", ()))
    is_last = atlas.measured_count >= 0 and atlas.names[atlas.measured_count :] == recorded
    require(is_last, "the looks must be the last entries, by their names")
    require(tuple(data.lattice.nodes[[0, -1]]) == (0, 1), "the nodes must run from 0 to 1")
    require(in_range(points.status, 0, len(Status) - 1), "every status must be known")
    require(bool(points.present.all()), "absent points must not be stored")
    require(in_range(points.entry, -1, len(atlas.names) - 1), "every entry must be in the atlas table")
    require(in_range(atlas.half_width, 0, 1), "half widths must be in [0, 1]")
    require(in_range(atlas.rgb, 0, 1), "the RGB of every entry must be in [0, 1]")
    if atlas.left_out is not None:
        require(atlas.measured_count > 0, "left-out spectra need entries")
        valid = in_range(atlas.left_out.measured, 0, 1) and in_range(atlas.left_out.answered, 0, 1)
        require(valid, "left-out entries must have reflectances in [0, 1]")


def _check_models(model: Model, entry_model: Model) -> None:
    one, other = ({**each.describe(), "count": None} for each in (model, entry_model))
    extends = one == other and entry_model.count >= model.count
    require(extends, "the model of the entries must extend that of the nodes")


def _check_sensor(data: CubeData) -> None:
    sensor = data.sensor
    with np.errstate(all="ignore"):
        basis = data.model.basis(sensor.wavelengths)
        white, condition = sensor.matrix.sum(axis=1), np.linalg.cond(sensor.xyz_to_rgb)
    valid = basis.shape == (len(sensor.wavelengths), data.model.count) and bool(np.isfinite(basis).all())
    require(valid, "the model must have a range of wavelengths")
    require(in_range(white, 1 - 1e-6, 1 + 1e-6), "the perfect reflector must have RGB (1, 1, 1)")
    require(bool(condition < MAX_CONDITION), "the RGB space must have three primaries")
    require(bool((np.diff(sensor.wavelengths) > 0).all()), "the wavelengths of the sensor must ascend")
    require(bool((np.diff(sensor.decoding) >= 0).all()), "the decoding of 8-bit codes must not decrease")


def _expand(points: PointTable, numbers: NDArray[Any], lattice: Lattice) -> PointTable:
    """Expand the rows (m, …) of the points ``numbers`` (m,) to those of the lattice, (n, …)."""
    size = lattice.size
    ascending = 0 < len(numbers) < size <= MAX_POINTS and bool((np.diff(numbers.astype(np.int64)) > 0).all())
    valid = ascending and bool(numbers[-1] < size)
    require(valid, "point numbers must ascend within the lattice, with some missing")
    require(_has_complete_cell(numbers.astype(np.int64), lattice), "one cell must have all its corners")
    arrays: dict[str, Any] = {}
    for name in POINTS:
        rows = getattr(points, name)
        if rows is not None:
            shape = (size, *rows.shape[1:])
            # Pages of zeros take no memory before they are written.
            absent = ABSENT_VALUES.get(name)
            arrays[name] = np.zeros(shape, rows.dtype) if absent is None else np.full(shape, absent, rows.dtype)
            arrays[name][numbers] = rows
    return PointTable(**arrays)


def _has_complete_cell(numbers: Indices, lattice: Lattice) -> bool:
    low = numbers[(lattice.position(numbers) < lattice.dim - 1).all(axis=-1)]
    for corner in CORNERS:
        low = low[np.isin(low + lattice.index(corner), numbers, assume_unique=True)]
    return bool(low.size)
