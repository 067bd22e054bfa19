"""Read and write cube files (docs/cube-file.md)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.errors import CubeFileError
from uplift.cube import sparse
from uplift.cube.checks import (
    ATLAS_ARRAYS,
    ENTRY_COEFFICIENTS,
    LEFT_OUT_ARRAYS,
    POINT_TYPES,
    SENSITIVITIES,
    SENSOR_ARRAYS,
    check,
    check_tensors,
    require,
)
from uplift.cube.container import (
    INVALID,
    Kind,
    Tensors,
    content_digest,
    error_text,
    invalid_file,
    load,
    replace_file,
)
from uplift.cube.data import AtlasTable, CubeData, EntrySpectra, LeftOut
from uplift.cube.metadata import check_metadata
from uplift.lattice import Lattice, PointTable
from uplift.models import from_description

FORMAT = "uplift cube"
VERSION = 4
READABLE = (3, 4)
"""Versions that are read. The entries of version 3 have as many coefficients as the nodes."""
KIND = Kind(FORMAT, READABLE, "cube", "not-a-cube")
LEFT_OUT = "left-out"
"""Feature of files with left-out entries."""
CAMERA = "camera"
"""Feature of files of a camera's raw values."""
FEATURES = {"debug": "round", "errors": "standard_error"}
"""Optional arrays by the features that announce them."""


def write(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a cube file, atomically. The new file is read back before it replaces an existing one.

    Parameters
    ----------
    data : CubeData
        The cube.
    path : path-like
        File to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        The file exists and ``force`` is false, cannot be written, or does not read back (``cube-unreadable``).
    """
    replace_file(contents(data), path, KIND, read, force=force)


def read(path: str | os.PathLike[str]) -> CubeData:
    """Read a cube file, and check its digest and all its content.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    CubeData
        The cube.

    Raises
    ------
    CubeFileError
        The file is missing (``cube-not-found``), damaged (``cube-damaged``), not a cube (``not-a-cube``), of another
        version (``cube-version``), or its content is invalid (``cube-invalid``, or a code of `check`).
    """
    path = Path(path)
    tensors, metadata = load(path, KIND)
    try:
        if metadata["version"] < VERSION:
            metadata["entry_model"] = metadata.get("model")
        check_metadata(metadata)
        data = _data(tensors, metadata)
        check(data)
        if sparse.FEATURE in metadata["features"]:
            data = replace(data, points=sparse.expand(data.points, tensors[sparse.POINTS], data.lattice))
        size, count = data.lattice.size, len(data.points)
        require(count == size, "invalid-array", f"there must be {size} points, got {count}")
    except CubeFileError as error:
        raise invalid_file(path, KIND, f"is not a valid cube: {error.problem}", error.code) from error
    except INVALID as error:
        problem = f"is not a valid cube ({type(error).__name__}: {error_text(error)})"
        raise invalid_file(path, KIND, problem, "cube-invalid") from error
    return data


def digest(data: CubeData) -> str:
    """Compute the digest of a cube. Cubes with equal digests give equal answers, bit for bit.

    Parameters
    ----------
    data : CubeData
        The cube.

    Returns
    -------
    str
        SHA-256 in hexadecimal.
    """
    tensors, metadata = contents(data)
    return content_digest(tensors, metadata)


def contents(data: CubeData) -> tuple[Tensors, dict[str, Any]]:
    """Return the content of a cube file without the digest.

    Parameters
    ----------
    data : CubeData
        The cube.

    Returns
    -------
    tensors : dict of str to ndarray
        Arrays by their names in the file.
    metadata : dict
        JSON values.
    """
    return _tensors(data), _metadata(data)


def _tensors(data: CubeData) -> Tensors:
    tensors: Tensors = {"nodes": data.lattice.nodes}
    tensors |= {f"sensor.{name}": getattr(data.sensor, name) for name in SENSOR_ARRAYS}
    if data.sensor.sensitivities is not None:
        tensors[SENSITIVITIES] = data.sensor.sensitivities
    tensors |= {f"atlas.{name}": getattr(data.atlas, attribute) for name, attribute in ATLAS_ARRAYS.items()}
    if data.atlas.spectra is not None:
        tensors[ENTRY_COEFFICIENTS] = data.atlas.spectra.coefficients
    if data.atlas.left_out is not None:
        tensors |= {name: getattr(data.atlas.left_out, key) for key, name in LEFT_OUT_ARRAYS.items()}
    for name, kinds in POINT_TYPES.items():
        array = getattr(data.points, name)
        if array is not None:
            kind = array.dtype if array.dtype.name in kinds else kinds[-1]
            tensors[name] = np.ascontiguousarray(array, dtype=kind)
    return tensors if data.complete_cells is None else sparse.gather(tensors, POINT_TYPES, data.points.present)


def _metadata(data: CubeData) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "version": VERSION,
        "features": _features(data),
        "model": data.model.describe(),
        "entry_model": data.entry_spectra.model.describe(),
        "dim": data.lattice.dim,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "reference": data.error_illuminant,
        "entries": list(data.atlas.names),
        "provenance": dict(data.provenance),
    }


def _features(data: CubeData) -> list[str]:
    optional = [name for name, array in FEATURES.items() if getattr(data.points, array) is not None]
    optional += [LEFT_OUT] if data.atlas.left_out is not None else []
    optional += [CAMERA] if data.sensor.sensitivities is not None else []
    return optional if data.complete_cells is None else [*optional, sparse.FEATURE]


def _data(tensors: Tensors, metadata: Mapping[str, Any]) -> CubeData:
    """Content of a file; the points of a sparse cube are not expanded."""
    model, entry_model = (from_description(metadata[key]) for key in ("model", "entry_model"))
    features = metadata["features"]
    looks = len(metadata["provenance"].get("looks", ()))
    check_tensors(tensors, len(tensors["status"]), model.count, len(metadata["entries"]), entry_model.count, looks)
    lattice = Lattice(tensors["nodes"])
    require(metadata["dim"] == lattice.dim, "invalid-metadata", f"dim must be {lattice.dim}, the number of nodes")
    absent = {array for feature, array in FEATURES.items() if feature not in features}
    arrays: dict[str, Any] = {name: None if name in absent else tensors[name] for name in POINT_TYPES}
    sensor: dict[str, Any] = {name: tensors[f"sensor.{name}"] for name in SENSOR_ARRAYS}
    sensor |= {"sensitivities": tensors[SENSITIVITIES]} if CAMERA in features else {}
    return CubeData(
        model=model,
        lattice=lattice,
        sensor=Sensor(
            metadata["space"],
            metadata["illuminant"],
            metadata["observer"],
            **sensor,
        ),
        threshold=float(metadata["threshold"]),
        error_illuminant=metadata["reference"],
        atlas=AtlasTable(
            tuple(metadata["entries"]),
            **{attribute: tensors[f"atlas.{name}"] for name, attribute in ATLAS_ARRAYS.items()},
            spectra=(None if entry_model == model else EntrySpectra(entry_model, tensors[ENTRY_COEFFICIENTS])),
            left_out=(
                LeftOut(**{key: tensors[name] for key, name in LEFT_OUT_ARRAYS.items()})
                if LEFT_OUT in features
                else None
            ),
            looks=looks,
        ),
        provenance=metadata["provenance"],
        points=PointTable(**arrays),
    )
