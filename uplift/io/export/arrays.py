"""Cubes as arrays and tables: the contents of a cube file as npz, and its nodes as CSV."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from itertools import chain

import numpy as np

from uplift.common.arrays import Indices
from uplift.common.csv import CsvWriter
from uplift.common.files import atomic_write
from uplift.cube import CubeData, contents
from uplift.lattice import Status

BLOCK = 1 << 12
"""Nodes converted to text at a time."""


def write_npz(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write a cube as an ``.npz`` file without pickled objects; return the number of arrays.

    The file has the arrays of docs/cube-file.md under their names. In addition, it has ``multipliers`` (n, C) of the
    nodes in ``model`` and ``atlas.multipliers`` (E, K) of the entries in ``entry_model``, from which spectra are
    evaluated directly, ``atlas.names`` (E,), and ``metadata``, the JSON text with both models.
    """
    tensors, metadata = contents(data)
    arrays = tensors | {
        "multipliers": data.model.from_storage(data.points.coefficients[data.points.present]),
        "atlas.multipliers": data.entry_spectra.multipliers,
        "atlas.names": np.array(data.atlas.names, dtype=np.str_),
        "metadata": np.array(json.dumps(metadata, ensure_ascii=False, allow_nan=False)),
    }
    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    return len(arrays)


def write_csv(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write the nodes of a cube as CSV, below a line of column names; return their number.

    Columns are linear target and lattice RGB, fitting distance, status, the atlas entry that the node is based on, if
    any, round and standard error of cubes that have them, and the coefficients. Absent nodes are left out.
    """
    with (
        atomic_write(path, force=force) as temporary,
        temporary.open("w", encoding="utf-8", newline="") as file,
    ):
        writer = CsvWriter(file)
        writer.write(_column_names(data))
        nodes = np.flatnonzero(data.points.present)
        for first in range(0, len(nodes), BLOCK):
            for row in _rows(data, nodes[first : first + BLOCK]):
                writer.write(row)
    return len(nodes)


def _column_names(data: CubeData) -> list[str]:
    optional = [name for name in ("round", "standard_error") if getattr(data.points, name) is not None]
    return [
        *("r", "g", "b", "lattice_r", "lattice_g", "lattice_b", "distance", "status", "entry"),
        *optional,
        *(f"c{order}" for order in range(data.model.count)),
    ]


def _rows(data: CubeData, block: Indices) -> Iterator[list[object]]:
    entries = [*data.atlas.names, ""]
    optional = [
        array[block, None].tolist() for array in (data.points.round, data.points.standard_error) if array is not None
    ]
    columns = zip(
        data.lattice.points[block].tolist(),
        data.points.rgb[block].tolist(),
        data.points.distance[block, None].tolist(),
        ([Status(status).label] for status in data.points.status[block]),
        ([entries[entry]] for entry in data.points.entry[block]),
        *optional,
        data.points.coefficients[block].tolist(),
        strict=True,
    )
    return (list(chain.from_iterable(row)) for row in columns)
