"""The cube file: a safetensors container with one JSON text of metadata (docs/cube-file.md). Same cube, same bytes."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.errors import CubeFileError, UpliftError
from uplift.common.files import atomic_write
from uplift.cube import sparse
from uplift.cube.checks import ATLAS_ARRAYS, POINT_TYPES, SENSOR_ARRAYS, check
from uplift.cube.data import AtlasTable, CubeData
from uplift.lattice import Lattice, PointTable
from uplift.models import from_description

FORMAT = "uplift cube"
VERSION = 3
KEY = "uplift"
"""The one metadata entry: safetensors does not keep several in a fixed order."""

Tensors = dict[str, NDArray[Any]]
FEATURES = {"debug": "round", "errors": "standard_error"}
"""Arrays that a cube may have or not, by the feature that says so."""


def write(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write atomically. Raises `OutputError`."""
    from safetensors.numpy import save

    tensors, metadata = contents(data)
    metadata["digest"] = _digest(tensors, metadata)
    with atomic_write(path, force=force) as temporary:
        # Its own way to a file has a temporary one too, which nobody would remove if this process were killed.
        temporary.write_bytes(save(tensors, metadata={KEY: _json(metadata)}))


def read(path: str | os.PathLike[str]) -> CubeData:
    """Read and check everything. Raises `CubeFileError` for whatever is no whole cube of this version."""
    path = Path(path)
    tensors, metadata = _load(path)
    if metadata.get("format") != FORMAT:
        raise _broken(path, "is a safetensors file, but no uplift cube")
    if metadata.get("version") != VERSION:
        raise CubeFileError(
            f"is a cube of format version {metadata.get('version')}, this uplift reads version {VERSION}",
            path=path,
            hint="rebuild it, or use the uplift that wrote it",
        )
    digest = metadata.pop("digest", None)
    if digest != _digest(tensors, metadata):
        raise _broken(path, "is damaged: the content does not match its digest")
    try:
        data = _data(tensors, metadata)
        check(data, stored=len(tensors["status"]))
    except (
        AttributeError,
        KeyError,
        MemoryError,
        OverflowError,
        TypeError,
        ValueError,
        UpliftError,
    ) as error:
        raise _broken(path, f"is not a complete cube ({type(error).__name__}: {error})") from error
    return data


def digest(data: CubeData) -> str:
    """Hex SHA-256 of the content; the same for cubes that answer alike in every bit."""
    return _digest(*contents(data))


def contents(data: CubeData) -> tuple[Tensors, dict[str, Any]]:
    """The arrays that a file holds, by name, and its metadata but for the digest: JSON values."""
    return _tensors(data), _metadata(data)


def _load(path: Path) -> tuple[Tensors, dict[str, Any]]:
    from safetensors import SafetensorError, safe_open

    if not os.path.isfile(path):  # False for impossible names too, where Path.is_file raises
        raise CubeFileError("no such file", path=path, hint="'uplift build' makes cubes")
    try:
        with safe_open(path, framework="numpy") as file:
            metadata = json.loads((file.metadata() or {}).get(KEY, "{}"), parse_constant=_no_number)
            tensors = {name: file.get_tensor(name) for name in sorted(file.keys())}
    except (SafetensorError, ValueError, TypeError, OSError, RecursionError) as error:
        raise _broken(path, f"is not a cube file, or is cut short ({error})") from error
    if not isinstance(metadata, dict):
        raise _broken(path, "is a safetensors file, but no uplift cube")
    return tensors, metadata


def _no_number(text: str) -> None:
    raise ValueError(f"{text} is no number")


def _broken(path: Path, problem: str) -> CubeFileError:
    return CubeFileError(problem, path=path, hint="rebuild it with 'uplift build'")


def _json(metadata: Mapping[str, Any]) -> str:
    return json.dumps(metadata, sort_keys=True, ensure_ascii=False, separators=(",", ":"))


def _digest(tensors: Tensors, metadata: Mapping[str, Any]) -> str:
    content = hashlib.sha256(_json(metadata).encode())
    for name in sorted(tensors):
        array = np.ascontiguousarray(tensors[name])
        content.update(f"{name} {array.dtype.str} {array.shape}".encode())
        content.update(array.data)
    return content.hexdigest()


def _tensors(data: CubeData) -> Tensors:
    tensors: Tensors = {"nodes": data.lattice.nodes}
    tensors |= {f"sensor.{name}": getattr(data.sensor, name) for name in SENSOR_ARRAYS}
    tensors |= {f"atlas.{name}": getattr(data.atlas, attribute) for name, attribute in ATLAS_ARRAYS.items()}
    for name, kinds in POINT_TYPES.items():
        array = getattr(data.points, name)
        if array is not None:
            kind = array.dtype if array.dtype.name in kinds else kinds[-1]
            tensors[name] = np.ascontiguousarray(array, dtype=kind)
    return (
        tensors if data.complete_cells is None else sparse.gather(tensors, POINT_TYPES, data.points.present)
    )


def _metadata(data: CubeData) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "version": VERSION,
        "features": _features(data),
        "model": data.model.describe(),
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
    return optional if data.complete_cells is None else [*optional, sparse.FEATURE]


def _data(tensors: Tensors, metadata: Mapping[str, Any]) -> CubeData:
    lattice = Lattice(tensors["nodes"])
    if sparse.FEATURE in metadata["features"]:
        tensors = sparse.scatter(tensors, POINT_TYPES, lattice.size)
    absent = {array for feature, array in FEATURES.items() if feature not in metadata["features"]}
    arrays: dict[str, Any] = {name: None if name in absent else tensors[name] for name in POINT_TYPES}
    return CubeData(
        model=from_description(metadata["model"]),
        lattice=lattice,
        sensor=Sensor(
            metadata["space"],
            metadata["illuminant"],
            metadata["observer"],
            *(tensors[f"sensor.{name}"] for name in SENSOR_ARRAYS),
        ),
        threshold=float(metadata["threshold"]),
        error_illuminant=metadata["reference"],
        atlas=AtlasTable(
            tuple(metadata["entries"]),
            **{attribute: tensors[f"atlas.{name}"] for name, attribute in ATLAS_ARRAYS.items()},
        ),
        provenance=metadata["provenance"],
        points=PointTable(**arrays),
    )
