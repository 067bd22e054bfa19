"""Read and write cube files (docs/cube-file.md)."""

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
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
from uplift.models import from_description

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
MIN_THRESHOLD, MAX_THRESHOLD = 1e-12, 0.1
"""Linear RGB. Smaller distances are lost in the rounding of double precision."""
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
    atlas = data.atlas
    arrays: dict[str, Any] = {
        "nodes": data.lattice.nodes,
        **{f"sensor.{name}": getattr(data.sensor, name) for name in SENSOR},
        "atlas.left_out": atlas.left_out,
        **{name: getattr(data.points, name) for name in POINTS},
    }
    for prefix, table in (("atlas", atlas), ("outside", atlas.outside)):
        if table is not None:
            spectra = (
                None
                if table.spectra.model == data.model
                else table.spectra.coefficients
            )
            columns = (
                table.rgb,
                table.coefficients,
                table.half_width,
                table.error,
                spectra,
                table.measured,
            )
            arrays |= {
                f"{prefix}.{name}": column
                for name, column in zip((*TABLE, "measured"), columns, strict=True)
            }
    tensors = {}
    for name, array in arrays.items():
        if (
            array is not None
        ):  # in a type that its file may have: its own, or else the most precise one
            types = ARRAYS[name].types
            tensors[name] = np.ascontiguousarray(
                array, array.dtype if array.dtype.name in types else types[-1]
            )
    present = data.points.present
    if not present.all():
        # A sparse file has the rows of the present nodes, and their numbers.
        tensors |= {
            name: np.ascontiguousarray(tensors[name][present])
            for name in POINTS
            if name in tensors
        }
        tensors["points"] = np.flatnonzero(present).astype(np.uint32)
    announced = {ARRAYS[name].feature for name in tensors}
    metadata = {
        "format": FORMAT,
        "version": VERSION,
        "features": [feature for feature in FEATURES if feature in announced],
        "model": data.model.describe(),
        "entry_model": atlas.spectra.model.describe(),
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


def _decode(tensors: Tensors, metadata: dict[str, Any]) -> CubeData:
    """Make the cube of a file after a check of types and ranges, of metadata first,
    then of arrays.
    """
    # In version 3 nodes and entries share one model.
    if metadata["version"] < VERSION:
        metadata["entry_model"] = metadata.get("model")
    check_metadata(metadata, METADATA)
    model, entry_model = (
        from_description(metadata[key]) for key in ("model", "entry_model")
    )
    alike = metadata["model"] | {"count": None} == metadata["entry_model"] | {
        "count": None
    }
    require(
        alike and entry_model.count >= model.count,
        "the model of the entries must extend that of the nodes",
    )
    names = tuple(metadata["entries"])
    looks = len(metadata["provenance"].get("looks", ()))
    outside = tuple(metadata["provenance"].get("left_out", ()))
    schema = {
        name: stored
        for name, stored in ARRAYS.items()
        if stored.feature in ("", *metadata["features"])
    }
    if entry_model == model:
        schema = {
            name: stored
            for name, stored in schema.items()
            if not name.endswith(ENTRY_COEFFICIENTS)
        }
    sizes = {
        "C": model.count,
        "K": entry_model.count,
        "E": len(names),
        "M": len(names) - looks,
        "O": len(outside),
    }
    for axis, name in (("D", "nodes"), ("n", "status"), ("N", "sensor.wavelengths")):
        sizes[axis] = tensors[name].size
    check_arrays(tensors, schema, sizes)
    arrays: dict[str, Any] = {name: tensors[name] for name in schema}

    def table(names: tuple[str, ...], prefix: str, **others: Any) -> AtlasTable:
        rgb, coefficients, half_width, error = (
            arrays[f"{prefix}.{name}"] for name in list(TABLE)[:-1]
        )
        spectra = EntrySpectra(
            entry_model, arrays.get(f"{prefix}.{ENTRY_COEFFICIENTS}", coefficients)
        )
        measured = arrays.get(f"{prefix}.measured")
        return AtlasTable(
            names, rgb, coefficients, half_width, error, spectra, measured, **others
        )

    data = CubeData(
        model=model,
        lattice=Lattice(tensors["nodes"]),
        sensor=Sensor(
            metadata["space"],
            metadata["illuminant"],
            metadata["observer"],
            **{
                name: arrays[f"sensor.{name}"]
                for name in SENSOR
                if f"sensor.{name}" in arrays
            },
        ),
        threshold=float(metadata["threshold"]),
        error_illuminant=metadata["reference"],
        atlas=table(
            names,
            "atlas",
            left_out=arrays.get("atlas.left_out"),
            looks=looks,
            outside=table(outside, "outside") if "outside.rgb" in arrays else None,
        ),
        provenance=metadata["provenance"],
        points=PointTable(**{name: arrays[name] for name in POINTS if name in arrays}),
    )
    require(
        metadata["dim"] == data.lattice.dim,
        f"dim must be {data.lattice.dim}, the number of nodes",
    )
    _check(data)
    if "points" in arrays:
        data = replace(
            data,
            points=_expand(
                data.points, arrays["points"].astype(np.int64), data.lattice
            ),
        )
    size = data.lattice.size
    count = data.points.status.size
    require(count == size, f"there must be {pluralise(size, 'node')}, got {count}")
    return data


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
