"""Read and write cube files (docs/cube-file.md)."""

import os
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry import Sensor
from uplift.colorimetry.likely_errors import LeftOut
from uplift.common.arrays import Array, Indices
from uplift.common.text import pluralise
from uplift.cube.container import (
    Kind,
    Stored,
    Tensors,
    check_arrays,
    check_metadata,
    content_digest,
    load,
    require,
    save,
)
from uplift.cube.data import AtlasTable, CubeData, EntrySpectra
from uplift.lattice import CORNERS, Lattice, PointTable, Status
from uplift.models import Model, from_description

FORMAT = "uplift cube"
VERSION = 4
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
KIND = Kind(FORMAT, (3, VERSION), "cube", foreign="not-a-cube", features=FEATURES)
"""Versions that are read. The entries of version 3 have as many coefficients as the
nodes.
"""
MAX_POINTS = 1 << 27
"""Nodes of the largest lattice of a sparse file, as a small file must not claim all
memory.
"""
MAX_CONDITION = 1e6
"""Limit of the condition number of the matrix from XYZ to RGB."""
MIN_THRESHOLD = 1e-12
"""Linear RGB. Smaller distances are lost in the rounding of double precision."""
MAX_THRESHOLD = 0.1
"""Linear RGB."""
MAX_LIGHTS = 64
MAX_FILES = 10_000

SINGLE = ("float32",)
POINTS = {
    "coefficients": Stored("n C", ("float32", "float64")),
    "rgb": Stored("n 3", SINGLE),
    "distance": Stored("n", SINGLE, 0),
    "status": Stored("n", ("uint8",), 0, Status.UNREALISABLE),
    "entry": Stored("n", ("int32",), -1),
    "round": Stored("n", ("int16",), feature="debug"),
    "standard_error": Stored("n", SINGLE, 0, feature="errors"),
}
"""Arrays of the `PointTable`. Sparse files have rows of the present nodes only."""
SENSOR = {
    "wavelengths": Stored("N", low=0),
    "cmfs": Stored("N 3"),
    "power": Stored("N", low=0),
    "xyz_to_rgb": Stored("3 3"),
    "decoding": Stored("256"),
    "sensitivities": Stored("N 3", low=0, feature="camera"),
}
ENTRY_COEFFICIENTS = "entry_coefficients"
TABLE = {
    "rgb": Stored("E 3", low=0, high=1),
    "coefficients": Stored("E C"),
    "reach": Stored("E", low=0, high=1),
    "error": Stored("E", low=0),
    ENTRY_COEFFICIENTS: Stored("E K"),
}
"""Arrays of an `AtlasTable`: entries in the RGB space, and those outside it, whose
colours are not in [0, 1].
"""
OUTSIDE = {
    name: stored._replace(shape=f"O{stored.shape[1:]}", feature="outside")
    for name, stored in TABLE.items()
}
OUTSIDE["rgb"] = Stored("O 3", feature="outside")
FAMILIES = {
    "rgb": Stored("F 3", low=0, high=1, feature="families"),
    "family": Stored("F", ("uint8",), feature="families"),
    "measured": Stored("F N", SINGLE, 0, 1, feature="families"),
    "predicted": Stored("F N", SINGLE, 0, 1, feature="families"),
}
"""Arrays of the `LeftOut` families."""
ARRAYS = {
    "nodes": Stored("D", low=0, high=1),
    "points": Stored("n", ("uint32",), feature="sparse"),
    **POINTS,
    **{f"sensor.{name}": stored for name, stored in SENSOR.items()},
    **{f"atlas.{name}": stored for name, stored in TABLE.items()},
    **{f"outside.{name}": stored for name, stored in OUTSIDE.items()},
    "atlas.measured": Stored("M N", SINGLE, 0, 1, feature="left-out"),
    "atlas.left_out": Stored("M N", SINGLE, 0, 1, feature="left-out"),
    "outside.measured": Stored("O N", SINGLE, 0, 1, feature="outside-measured"),
    **{f"families.{name}": stored for name, stored in FAMILIES.items()},
}
"""All arrays of a file by name. Letters as in docs/cube-file.md, and D for the number
of nodes along an axis.
"""

NUMBER = (-1e30, 1e30)
POSITIVE = (0, 1e30)
ENTRIES = [str, 1_000_000]
RGB = [NUMBER, 3]
FILE = {"name": str, "digest": str}
LIGHT = {
    "light": str,
    "wish": RGB,
    "answer": RGB,
    "delta_e": POSITIVE,
    "possible": POSITIVE,
}
PROVENANCE = {
    "uplift?": str,
    "options?": {"*": None},  # which are checked where a build is repeated
    "atlases?": [{**FILE, "measured?": str, "missing?": str}, MAX_FILES],
    "libraries?": [FILE, MAX_FILES],
    "families?": [{"name": str, "relevance": NUMBER}, MAX_FILES],
    "looks?": [
        {"name": str, "rgb": RGB, "weight": (0, 1), "lights": [LIGHT, MAX_LIGHTS]},
        MAX_FILES,
    ],
    "left_out?": ENTRIES,
    "left_out_families?": [str, 256],
    "skipped?": ENTRIES,
    "prior?": {
        "length?": POSITIVE,
        "nugget?": POSITIVE,
        "noise?": POSITIVE,
        "error_bound?": POSITIVE,
        "*": None,
    },
    "improvements?": [{"step": str, "tried": int, "mended": int}, MAX_FILES],
    "scene?": [{"*": None}, MAX_FILES],
    "filled?": {"points": int, "cube": str},
    "*": None,
}
MODEL = {
    "name": str,
    "count?": int,
    "phase?": {"start": NUMBER, "end": NUMBER, "warp": str},
    "start?": NUMBER,
    "end?": NUMBER,
}
METADATA = {
    "format": str,
    "version": int,
    "features": [str, 100],
    "model": MODEL,
    "entry_model": MODEL,
    "dim": int,
    "space": str,
    "illuminant": str,
    "observer": str,
    "threshold": (MIN_THRESHOLD, MAX_THRESHOLD),
    "reference": str,
    "entries": ENTRIES,
    "provenance": PROVENANCE,
}
"""The schema of the metadata, by `check_metadata`."""


def write(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a cube file, atomically. The new file is read back before it replaces an
    existing one.
    """
    save(contents(data), path, KIND, read, force=force)


def read(path: str | os.PathLike[str]) -> CubeData:
    """Read a cube file. A file that is missing, damaged, of another kind or invalid is
    a `CubeFileError`.
    """
    return load(Path(path), KIND, _decode)


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
    for name in SENSOR:
        arrays[f"sensor.{name}"] = getattr(data.sensor, name)
    arrays["atlas.left_out"] = data.atlas.left_out
    for name in POINTS:
        arrays[name] = getattr(data.points, name)
    arrays |= _table_arrays("atlas", data.atlas, data.model)
    if data.atlas.outside is not None:
        arrays |= _table_arrays("outside", data.atlas.outside, data.model)
    if data.families is not None:
        for name in FAMILIES:
            arrays[f"families.{name}"] = getattr(data.families, name)
    return arrays


def _table_arrays(prefix: str, table: AtlasTable, model: Model) -> dict[str, Any]:
    """Return the arrays of entries, whose spectra may be those in the model of
    nodes.
    """
    is_shared = table.spectra.model == model
    return {
        f"{prefix}.rgb": table.rgb,
        f"{prefix}.coefficients": table.coefficients,
        f"{prefix}.reach": table.half_width,
        f"{prefix}.error": table.error,
        f"{prefix}.{ENTRY_COEFFICIENTS}": None
        if is_shared
        else table.spectra.coefficients,
        f"{prefix}.measured": table.measured,
    }


def _decode(tensors: Tensors, metadata: dict[str, Any]) -> CubeData:
    """Make the cube of a file after a check of types and ranges, of metadata first,
    then of arrays.
    """
    # In version 3 nodes and entries share one model.
    if metadata["version"] < VERSION:
        metadata["entry_model"] = metadata.get("model")
    check_metadata(metadata, METADATA)
    model, entry_model = _models(metadata)
    schema = _schema(metadata["features"], is_shared=entry_model == model)
    check_arrays(tensors, schema, _sizes(tensors, metadata, model, entry_model))
    arrays: dict[str, Any] = {name: tensors[name] for name in schema}
    data = CubeData(
        model=model,
        lattice=Lattice(arrays["nodes"]),
        sensor=_sensor(arrays, metadata),
        threshold=float(metadata["threshold"]),
        error_illuminant=metadata["reference"],
        atlas=_atlas(arrays, metadata, entry_model),
        provenance=metadata["provenance"],
        points=PointTable(**{name: arrays[name] for name in POINTS if name in arrays}),
        families=_families(arrays, metadata["provenance"]),
    )
    require(
        metadata["dim"] == data.lattice.dim,
        f"dim must be {data.lattice.dim}, the number of nodes",
    )
    _check(data)
    if "points" in arrays:
        numbers = arrays["points"].astype(np.int64)
        data = replace(data, points=_expand(data.points, numbers, data.lattice))
    size = data.lattice.size
    count = data.points.status.size
    require(count == size, f"there must be {pluralise(size, 'node')}, got {count}")
    return data


def _models(metadata: dict[str, Any]) -> tuple[Model, Model]:
    """Return the models of nodes and of entries, which differ in their counts only."""
    model = from_description(metadata["model"])
    entry_model = from_description(metadata["entry_model"])
    uncounted = metadata["model"] | {"count": None}
    entry_uncounted = metadata["entry_model"] | {"count": None}
    require(
        uncounted == entry_uncounted and entry_model.count >= model.count,
        "the model of the entries must extend that of the nodes",
    )
    return model, entry_model


def _schema(features: list[str], is_shared: bool) -> dict[str, Stored]:
    """Return the arrays of a file, where nodes and entries may share one model."""
    schema = {}
    for name, stored in ARRAYS.items():
        is_repeated = is_shared and name.endswith(ENTRY_COEFFICIENTS)
        if stored.feature in ("", *features) and not is_repeated:
            schema[name] = stored
    return schema


def _sizes(
    tensors: Tensors, metadata: dict[str, Any], model: Model, entry_model: Model
) -> dict[str, int]:
    """Return the lengths that the letters of shapes stand for."""
    count = len(metadata["entries"])
    provenance = metadata["provenance"]
    return {
        "C": model.count,
        "K": entry_model.count,
        "E": count,
        "M": count - len(provenance.get("looks", ())),
        "O": len(provenance.get("left_out", ())),
        "D": tensors["nodes"].size,
        "F": np.size(tensors.get("families.family", ())),
        "n": tensors["status"].size,
        "N": tensors["sensor.wavelengths"].size,
    }


def _sensor(arrays: dict[str, Any], metadata: dict[str, Any]) -> Sensor:
    columns: dict[str, Any] = {name: arrays.get(f"sensor.{name}") for name in SENSOR}
    return Sensor(
        metadata["space"], metadata["illuminant"], metadata["observer"], **columns
    )


def _atlas(
    arrays: dict[str, Any], metadata: dict[str, Any], model: Model
) -> AtlasTable:
    provenance = metadata["provenance"]
    table = _table(arrays, "atlas", metadata["entries"], model)
    outside = None
    if "outside.rgb" in arrays:
        outside = _table(arrays, "outside", provenance.get("left_out", ()), model)
    return replace(
        table,
        left_out=arrays.get("atlas.left_out"),
        looks=len(provenance.get("looks", ())),
        outside=outside,
    )


def _families(arrays: dict[str, Any], provenance: dict[str, Any]) -> LeftOut | None:
    if "families.family" not in arrays:
        return None
    columns = {name: arrays[f"families.{name}"] for name in FAMILIES}
    return LeftOut(**columns, names=tuple(provenance.get("left_out_families", ())))


def _table(
    arrays: dict[str, Any], prefix: str, names: Iterable[str], model: Model
) -> AtlasTable:
    coefficients = arrays[f"{prefix}.coefficients"]
    # Entries with as many coefficients as nodes have them once.
    entry_coefficients = arrays.get(f"{prefix}.{ENTRY_COEFFICIENTS}", coefficients)
    return AtlasTable(
        names=tuple(names),
        rgb=arrays[f"{prefix}.rgb"],
        coefficients=coefficients,
        half_width=arrays[f"{prefix}.reach"],
        error=arrays[f"{prefix}.error"],
        spectra=EntrySpectra(model, entry_coefficients),
        measured=arrays.get(f"{prefix}.measured"),
    )


def _check(data: CubeData) -> None:
    """Check what a lookup relies on beyond types and ranges. The nodes of a sparse cube
    are those in its file.
    """
    atlas = data.atlas
    sensor = data.sensor
    nodes = data.lattice.nodes
    names = (*atlas.names, *(() if atlas.outside is None else atlas.outside.names))
    looks = tuple(look["name"] for look in data.provenance.get("looks", ()))
    with np.errstate(all="ignore"):
        basis = data.model.basis(sensor.wavelengths)
        white = sensor.matrix.sum(axis=1)
        regular = all(
            map(
                _has_three_channels,
                (sensor.xyz_to_rgb, sensor.light.xyz, sensor.matrix),
            )
        )
    has_basis = basis.shape == (len(sensor.wavelengths), data.model.count) and bool(
        np.isfinite(basis).all()
    )
    for condition_met, problem in (
        (len(set(names)) == len(names), "the names of entries must be unique"),
        (
            looks == atlas.names[len(atlas.names) - atlas.looks :],
            "the looks must be the last entries, by their names",
        ),
        (
            atlas.left_out is None or atlas.looks < len(atlas.names),
            "left-out spectra need entries",
        ),
        (has_basis, "the model must have a range of wavelengths"),
        ((nodes[0], nodes[-1]) == (0, 1), "the nodes must run from 0 to 1"),
        (
            data.points.entry.max(initial=-1) < len(atlas.names),
            "every entry must be in the atlas table",
        ),
        (
            (np.abs(white - 1) <= 1e-6).all(),
            "the perfect reflector must have RGB (1, 1, 1)",
        ),
        (
            regular,
            "observer, RGB space and camera must have three independent channels",
        ),
        (
            (np.diff(sensor.wavelengths) > 0).all(),
            "the wavelengths of the sensor must ascend",
        ),
        (
            (np.diff(sensor.decoding) >= 0).all(),
            "the decoding of 8-bit codes must not decrease",
        ),
    ):
        require(bool(condition_met), problem)


def _has_three_channels(matrix: Array) -> bool:
    """Return whether the rows (3, …) of a matrix are independent of each other."""
    return bool(np.isfinite(matrix).all()) and bool(
        np.linalg.cond(matrix) < MAX_CONDITION
    )


def _expand(points: PointTable, numbers: Indices, lattice: Lattice) -> PointTable:
    """Expand the rows (m, …) of the nodes ``numbers`` (m,) to those of the lattice, (n,
    …).
    """
    size = lattice.size
    valid = (
        0 < len(numbers) < size <= MAX_POINTS
        and bool((np.diff(numbers) > 0).all())
        and bool(numbers[-1] < size)
    )
    require(valid, "point numbers must ascend within the lattice, with some missing")
    # A query needs all corners of a cell.
    low = numbers[(lattice.position(numbers) < lattice.dim - 1).all(axis=-1)]
    for corner in CORNERS:
        low = low[np.isin(low + lattice.index(corner), numbers, assume_unique=True)]
    require(low.size > 0, "one cell must have all its corners")
    return points.spread(numbers, size)


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
