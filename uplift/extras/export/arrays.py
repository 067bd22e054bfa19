"""Cubes as arrays and tables: the contents of a cube file as npz, and its
nodes as CSV.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import StrPath, Values, blocks
from uplift.common.files import atomic_write, write_text
from uplift.common.text import pluralise
from uplift.cube import CubeData, contents
from uplift.extras.files.csv import csv_text
from uplift.lattice import Status
from uplift.lookup import Cube

BLOCK = 1 << 12
"""Nodes converted to text at a time."""


def export_npz(cube: Cube, path: Path, style: str, *, force: bool) -> str:
    """Write all arrays."""
    return pluralise(write_npz(cube.data, path, force=force), "array")


def export_csv(cube: Cube, path: Path, style: str, *, force: bool) -> str:
    """Write the nodes."""
    return pluralise(write_csv(cube.data, path, force=force), "node")


def write_npz(data: CubeData, path: StrPath, *, force: bool = False) -> int:
    """Write a cube as an ``.npz`` file without pickled objects; return the number of
    arrays.

    The file has the arrays of docs/cube-file.md under their names. In addition, it has
    ``multipliers`` (n, C) of the nodes in ``model`` and ``atlas.multipliers`` (E, K) of
    the entries in ``entry_model``, from which spectra are evaluated directly,
    ``atlas.names`` (E,), the same of the entries outside the RGB space as
    ``outside.…``, if there are any, and ``metadata``, the JSON text with both models.
    """
    tensors, metadata = contents(data)
    arrays = tensors | {
        "multipliers": data.model.from_storage(
            data.points.coefficients[data.points.present]
        ),
        "metadata": np.array(json.dumps(metadata, ensure_ascii=False, allow_nan=False)),
    }
    for prefix, table in (("atlas", data.atlas), ("outside", data.atlas.outside)):
        if table is not None:
            arrays[f"{prefix}.multipliers"] = table.spectra.multipliers
            arrays[f"{prefix}.names"] = np.array(table.names, dtype=np.str_)
    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    return len(arrays)


def write_csv(data: CubeData, path: StrPath, *, force: bool = False) -> int:
    """Write the nodes of a cube as CSV, below a line of column names; return their
    number.

    Columns are linear target and lattice RGB, fitting distance, status, the atlas entry
    that the node is based on, if any, round and standard error of cubes that have them,
    and the coefficients. Absent nodes are left out.
    """
    points = data.points
    columns: dict[str, Values | None] = {
        **dict(zip("rgb", data.lattice.points.T, strict=True)),
        **dict(zip(("lattice_r", "lattice_g", "lattice_b"), points.rgb.T, strict=True)),
        "distance": points.distance,
        "status": np.array(
            [Status(status).label for status in points.status], dtype=object
        ),
        "entry": np.array([*data.atlas.names, ""], dtype=object)[points.entry],
        "round": points.round,
        "standard_error": points.standard_error,
        **{f"c{order}": column for order, column in enumerate(points.coefficients.T)},
    }
    arrays = {name: column for name, column in columns.items() if column is not None}
    nodes = np.flatnonzero(points.present)

    def node_rows() -> Iterator[tuple[Any, ...]]:
        for block in blocks(len(nodes), BLOCK):
            values = [column[nodes[block]].tolist() for column in arrays.values()]
            yield from zip(*values, strict=True)

    rows = node_rows()
    write_text(csv_text(list(arrays), rows), path, force=force)
    return len(nodes)
