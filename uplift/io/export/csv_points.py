"""The nodes of a cube as CSV, one line per node."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import chain

import numpy as np

from uplift.common.arrays import Indices
from uplift.common.csv import CsvWriter
from uplift.common.files import atomic_write
from uplift.cube import CubeData
from uplift.lattice import Status

BLOCK = 1 << 12
"""Nodes converted to text at a time."""


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
