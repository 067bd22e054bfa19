"""Read and write cube files (docs/cube-file.md)."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from uplift.cube.container import Kind, Tensors, content_digest, load, save
from uplift.cube.data import AtlasTable, CubeData
from uplift.cube.decode import decode
from uplift.cube.schema import (
    ARRAYS,
    ENTRY_COEFFICIENTS,
    FAMILIES,
    POINTS,
    SENSOR,
)
from uplift.models.model import Model

FORMAT = "uplift cube"
VERSION = 5
FEATURES = (
    "debug",
    "errors",
    "left-out",
    "camera",
    "sparse",
    "outside",
    "outside-measured",
    "families",
)
"""Optional parts of a file, in the order in which the metadata list them. Earlier
readers refuse a new one.
"""
KIND = Kind(FORMAT, (VERSION,), "cube", foreign="not-a-cube", features=FEATURES)
"""Nodes of earlier versions were fitted for another interpolation, and are not read."""


def write(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a cube file, atomically. The new file is read back before it replaces an
    existing one.
    """
    save(contents(data), path, KIND, read, force=force)


def read(path: str | os.PathLike[str]) -> CubeData:
    """Read a cube file. A file that is missing, damaged, of another kind or invalid is
    a `CubeFileError`.
    """
    return load(Path(path), KIND, decode)


def digest(data: CubeData) -> str:
    """Compute the SHA-256 of a cube, in hexadecimal. Cubes with equal digests give
    equal answers, bit for bit.
    """
    return content_digest(*contents(data))


def contents(data: CubeData) -> tuple[Tensors, dict[str, Any]]:
    """Return the arrays by their names in the file, and the metadata without the
    digest.
    """
    tensors = {
        name: np.ascontiguousarray(array, _stored_type(name, array.dtype))
        for name, array in _arrays(data).items()
        if array is not None
    }
    present = data.points.present
    if not present.all():
        # A sparse file has the rows of the present nodes, and their numbers.
        for name in tensors.keys() & POINTS.keys():
            tensors[name] = np.ascontiguousarray(tensors[name][present])
        tensors["points"] = np.flatnonzero(present).astype(np.uint32)
    announced = {ARRAYS[name].feature for name in tensors}
    metadata = {
        "format": FORMAT,
        "version": VERSION,
        "features": [feature for feature in FEATURES if feature in announced],
        "model": data.model.describe(),
        "entry_model": data.atlas.spectra.model.describe(),
        "dim": data.lattice.dim,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "reference": data.error_illuminant,
        "entries": list(data.atlas.names),
        "provenance": dict(data.provenance),
    }
    return tensors, metadata


def _stored_type(name: str, dtype: np.dtype[Any]) -> np.dtype[Any] | str:
    """Return the type of an array if its file may have it, or else the most precise."""
    types = ARRAYS[name].types
    return dtype if dtype.name in types else types[-1]


def _arrays(data: CubeData) -> dict[str, Any]:
    """Return the arrays by their names in the file; None for those that are missing."""
    arrays: dict[str, Any] = {"nodes": data.lattice.nodes}
    for prefix, part, names in (
        ("", data.points, POINTS),
        ("sensor.", data.sensor, SENSOR),
        ("families.", data.families, FAMILIES),
    ):
        for name in names:
            arrays[prefix + name] = getattr(part, name, None)
    arrays |= _table_arrays("atlas", data.atlas, data.model)
    arrays["atlas.left_out"] = data.atlas.left_out
    if data.atlas.outside is not None:
        arrays |= _table_arrays("outside", data.atlas.outside, data.model)
    return arrays


def _table_arrays(prefix: str, table: AtlasTable, model: Model) -> dict[str, Any]:
    """Return the arrays of entries, whose spectra may be those in the model of
    nodes.
    """
    spectra = table.spectra
    return {
        f"{prefix}.rgb": table.rgb,
        f"{prefix}.coefficients": table.coefficients,
        f"{prefix}.reach": table.half_width,
        f"{prefix}.error": table.error,
        f"{prefix}.{ENTRY_COEFFICIENTS}": (
            None if spectra.model == model else spectra.coefficients
        ),
        f"{prefix}.measured": table.measured,
    }


def summarise(data: CubeData) -> dict[str, Any]:
    """Return facts about a cube in JSON values, for ``uplift info`` and reports."""
    points = data.points
    present = points.present
    errors = points.standard_error
    return {
        "model": data.model.describe(),
        "coefficients": data.model.count,
        "entry_coefficients": data.atlas.spectra.model.count,
        "dim": data.lattice.dim,
        "nodes": int(np.count_nonzero(present)),
        "lattice_nodes": data.lattice.size,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "worst_distance": float(points.distance.max()),
        "mean_distance": float(points.distance[present].mean(dtype=np.float64)),
        "reference": data.error_illuminant,
        "mean_standard_error": None
        if errors is None
        else float(errors[present].mean(dtype=np.float64)),
        "status": points.counts(),
        "entries": list(data.atlas.names),
        "outside": [] if data.atlas.outside is None else list(data.atlas.outside.names),
        "debug": points.round is not None,
        "rounds": None if points.round is None else int(points.round.max()) + 1,
        "provenance": dict(data.provenance),
        "digest": digest(data),
    }
